// Documents of two plates of different size, and what their parts are judged by.
#pragma once

#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "mesh/document/judging_rules.h"
#include "tests/mesh/document/document_fixture.h"

namespace prismesh::mesh::document {

/// Plates of 6 x 5 quads of 5 and of 60, parts 1 and 2, and a quad of 5 by itself, part 3. Node ids 101.. and 201.., shells likewise.
inline Model two_plates() {
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  for (std::int64_t part = 1; part <= 2; ++part) {
    const double size = part == 1 ? 5 : 60;
    for (int j = 0; j <= 5; ++j)
      for (int i = 0; i <= 6; ++i)
        nodes.push_back({100 * part + 1 + i + 7 * j, Vec3(size * i, size * j, 100.0 * static_cast<double>(part))});
    for (int j = 0; j < 5; ++j)
      for (int i = 0; i < 6; ++i) {
        const std::int64_t corner = 100 * part + 1 + i + 7 * j;
        shells.push_back({100 * part + 1 + i + 6 * j, part, {corner, corner + 1, corner + 8, corner + 7}});
      }
  }
  for (int n = 0; n < 4; ++n) nodes.push_back({301 + n, Vec3(n == 1 || n == 2 ? 5 : 0, n > 1 ? 5 : 0, 900)});
  shells.push_back({301, 3, {301, 302, 303, 304}});
  return test::make_model(nodes, shells);
}

inline Result<Document> opened_with(OpenOptions options, const std::filesystem::path& path = "model.k") {
  auto deck = std::make_shared<deck::Deck>();
  deck->content = {9, 0};
  options.length_unit = LengthUnit::mm;
  return open(path, {deck, two_plates()}, options);
}

inline Document plates(std::vector<JudgingRule> rules = {}) {
  OpenOptions options;
  options.rules = std::move(rules);
  Result<Document> document = opened_with(options);
  EXPECT_TRUE(document) << document.error().text();
  return std::move(*document);
}

inline JudgingRule rule(std::optional<std::string> on, std::optional<TargetSize> size, std::optional<std::string> criteria = std::nullopt) {
  return {std::move(on), size, std::move(criteria), "", 0};
}

inline std::vector<double> sizes_of(const Document& document) {
  std::vector<double> sizes;
  for (std::size_t p = 0; p < document.current().model.parts->size(); ++p)
    sizes.push_back(judged_by(document).of(PartIndex(p)).target_size);
  return sizes;
}

inline std::vector<std::string> criteria_of(const Document& document) {
  std::vector<std::string> names;
  for (std::size_t p = 0; p < document.current().model.parts->size(); ++p)
    names.push_back(judged_by(document).of(PartIndex(p)).criteria.name);
  return names;
}

/// The states of the current generation, judged from the start.
inline void expect_judged(const Document& document) {
  const Generation& now = document.current();
  const auto fresh = quality::judge_model(now.model, judged_by(document));
  EXPECT_TRUE(same_bytes(now.quality, fresh));
  EXPECT_EQ(now.counts, quality::count(fresh));
}

/// An LS-DYNA deck of two plates of 10 x 8 quads, parts 1 and 2; the second is the first, 16 times as large. Multiplying by 16 is exact.
inline std::string plate_and_larger_one() {
  std::string nodes = "*KEYWORD\n*NODE\n", shells = "*ELEMENT_SHELL\n";
  char line[96];
  for (int part = 1; part <= 2; ++part) {
    const int by = part == 1 ? 1 : 16;
    for (int n = 0; n < 99; ++n) {
      std::snprintf(line, sizeof line, "%8d%16d%16d%16d\n", 1000 * part + n, by * 5 * (n % 11), by * 5 * (n / 11), by * 100);
      nodes += line;
    }
    for (int s = 0; s < 80; ++s) {
      const int corner = 1000 * part + s % 10 + 11 * (s / 10);
      std::snprintf(line, sizeof line, "%8d%8d%8d%8d%8d%8d\n", 1000 * part + s, part, corner, corner + 1, corner + 12, corner + 11);
      shells += line;
    }
  }
  return nodes + shells + "*END\n";
}

}  // namespace prismesh::mesh::document

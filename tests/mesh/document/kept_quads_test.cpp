// Repairs where a set names quads and can't name triangles: these shells stay quads or go over to another set, and everything else is
// repaired as without the set.
#include <cmath>
#include <cstdio>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/document/unwritable.h"
#include "mesh/model/topology_change.h"
#include "tests/mesh/document/document_fixture.h"
#include "tests/mesh/document/restructuring.h"

namespace prismesh::mesh::document {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

constexpr int kFanColumns = 24, kFanRows = 8;
constexpr int kFirstNamed = 3, kLastNamed = 5;  ///< rows that the group names

std::string integer_fields(const std::vector<std::int64_t>& ids) {
  std::string out;
  char field[16];
  for (std::size_t i = 0; i < ids.size(); ++i) {
    std::snprintf(field, sizeof field, "%10lld", static_cast<long long>(ids[i]));
    out += field;
    if (i % 10 == 9 || i + 1 == ids.size()) out += "\n";
  }
  return out;
}

/// A starter deck: a fan of quads, 8 rows from radius 60 to 140. Eight of its columns are so wide that the outer rows need twice as many
/// columns, which can't be made without triangles. /GRSHEL/SHEL/27 names the rows between; `user` uses it.
std::string fan_deck(const std::string& user) {
  std::string nodes, shells;
  char line[128];
  for (int j = 0; j <= kFanRows; ++j) {
    double angle = 0;
    for (int i = 0; i <= kFanColumns; ++i) {
      const double radius = 60 + 10.0 * j;
      std::snprintf(line, sizeof line, "%10d%20.6f%20.6f%20.6f\n", 1 + i + j * (kFanColumns + 1), radius * std::sin(angle),
                    radius * std::cos(angle), 0.0);
      nodes += line;
      angle += (i >= 8 && i < 16 ? 2.4 : 1.0) * 10 / 140;
    }
  }
  std::vector<std::int64_t> named;
  for (int j = 0; j < kFanRows; ++j)
    for (int i = 0; i < kFanColumns; ++i) {
      const int corner = 1 + i + j * (kFanColumns + 1), id = 1 + i + j * kFanColumns;
      shells += integer_fields({id, corner, corner + 1, corner + kFanColumns + 2, corner + kFanColumns + 1});
      if (j >= kFirstNamed && j <= kLastNamed) named.push_back(id);
    }
  return "#RADIOSS STARTER\n/BEGIN\nfan\n      2022         0\n                  kg                  mm                  ms\n"
         "                  kg                  mm                  ms\n/NODE\n" +
         nodes + "/SHELL/1\n" + shells +
         "/PART/1\nplate\n         1         1         0\n/PROP/SHELL/1\nplate\n         0         0         0         0         0\n\n"
         "         0         0                 1.5\n" +
         user + "/GRSHEL/SHEL/27\nbetween\n" + integer_fields(named) + "/END\n";
}

const std::string kSurface = "/SURF/GRSHEL/1\nsurface\n        27\n";
const std::string kSection = "/SECT/1\ncut\n" + integer_fields({1, 2, 3, 0}) + "\n" + integer_fields({0, 0, 27, 0, 0, 0, 0});

Document open_fan(const std::filesystem::path& path, const std::string& user) {
  put_content(path, fan_deck(user));
  OpenOptions options;
  options.length_unit = LengthUnit::mm;
  options.target_size = 10.0;
  return open(path, options).value();
}

bool is_named_by_group(const Model& model, ShellIndex shell) {
  const std::int64_t row = (model.shell_ids[deck_ancestor(model, shell).value] - 1) / kFanColumns;
  return row >= kFirstNamed && row <= kLastNamed;
}
std::size_t named_triangles(const Model& model) {
  std::size_t count = 0;
  for (std::size_t s = 0; s < model.shell_count(); ++s)
    count +=
        !model.is_removed(ShellIndex(s)) && model.shell(ShellIndex(s)).is_triangle() && is_named_by_group(model, ShellIndex(s)) ? 1 : 0;
  return count;
}

TEST(KeptQuads, only_the_sets_shells_stay_quads_and_all_damage_is_repaired) {
  const Folder folder;
  Document document = open_fan(folder / "fan_0000.rad", kSurface);
  const EditReport report = must_apply(document, R"({"edit":"repair","scope":"all"})");
  ASSERT_GE(report.before.warn + report.before.fail, 40u);
  EXPECT_LE(100 * (report.after.warn + report.after.fail), report.before.warn + report.before.fail) << "99 % of the damage";
  const Model& model = document.current().model;
  EXPECT_GT(report.elements_added, 0u);
  EXPECT_EQ(named_triangles(model), 0u);
  for (const std::string& note : report.notes) EXPECT_THAT(note, Not(HasSubstr("nothing was written")));
  const Result<deck::SaveReport> saved = save(document, folder / "out_0000.rad");
  ASSERT_TRUE(saved) << saved.error().text();
}

TEST(KeptQuads, a_section_uses_a_group_of_triangles_as_well) {
  const Folder folder;
  Document document = open_fan(folder / "fan_0000.rad", kSection);
  const EditReport report = must_apply(document, R"({"edit":"repair","scope":"all"})");
  EXPECT_EQ(report.after.warn + report.after.fail, 0u);
  const std::size_t triangles = named_triangles(document.current().model);
  EXPECT_GT(triangles, 0u);
  ASSERT_TRUE(save(document, folder / "out_0000.rad"));
  // The written groups say the same as the model.
  const std::string text = content_of(folder / "out_0000.rad");
  EXPECT_THAT(text, HasSubstr("/SECT/1\ncut\n" + integer_fields({1, 2, 3, 0}) + "\n" + integer_fields({0, 0, 27, 0, 0, 0, 27})));
  const std::size_t begin = text.find("/GRSH3N/SH3N/27\nbetween\n");
  ASSERT_NE(begin, std::string::npos);
  const Document again = open(folder / "out_0000.rad", {}).value();
  std::size_t in_quads = 0, in_triangles = 0;
  const auto cards = again.deck->references->referrers();
  const Model& model = again.current().model;
  for (std::size_t s = 0; s < model.shell_count(); ++s)
    for (const Reference& reference : again.deck->references->naming(Referred::shell, model.shell_ids[s])) {
      const bool of_triangles = cards[reference.referrer].keyword == "GRSH3N/SH3N";
      EXPECT_EQ(model.shell(ShellIndex(s)).is_triangle(), of_triangles) << "shell " << model.shell_ids[s];
      ++(of_triangles ? in_triangles : in_quads);
    }
  EXPECT_EQ(in_triangles, triangles);
  EXPECT_GT(in_quads, static_cast<std::size_t>(kFanColumns * (kLastNamed - kFirstNamed + 1)));
}

TEST(KeptQuads, a_shell_of_the_group_exchanges_area_with_others_of_it_only) {
  const Folder folder;
  const Document document = open_fan(folder / "fan_0000.rad", kSection);
  const Model& model = document.current().model;
  const repair::Rules rules = rules_for(document, document.current());
  const auto shell = [&](int row) { return model.find_shell(1 + row * kFanColumns); };
  EXPECT_TRUE(rules.may_exchange(shell(kFirstNamed), shell(kLastNamed)));
  EXPECT_TRUE(rules.may_exchange(shell(kFirstNamed - 1), shell(kLastNamed + 1))) << "no group has either";
  EXPECT_FALSE(rules.may_exchange(shell(kFirstNamed), shell(kFirstNamed - 1)));
  EXPECT_FALSE(rules.may_exchange(shell(kLastNamed + 1), shell(kLastNamed)));
}

TEST(KeptQuads, the_rules_say_it_before_the_search) {
  const Folder folder;
  for (const auto& [user, kept] : {std::pair(kSurface, true), std::pair(kSection, false)}) {
    const Document document = open_fan(folder / "fan_0000.rad", user);
    const Model& model = document.current().model;
    const repair::Rules rules = rules_for(document, document.current());
    for (std::size_t s = 0; s < model.shell_count(); ++s)
      EXPECT_EQ(rules.shell(ShellIndex(s)), kept && is_named_by_group(model, ShellIndex(s)) ? repair::kNoTriangle : 0) << s;
  }
}

}  // namespace
}  // namespace prismesh::mesh::document

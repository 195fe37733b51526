#include "mesh/deck/sample.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "base/hash.h"
#include "mesh/deck/data/deck.h"
#include "mesh/deck/data/length_unit.h"
#include "mesh/deck/open.h"
#include "mesh/deck/save.h"

namespace prismesh::mesh::deck {
namespace {

/// What the sample's text says, read by the simplest means.
struct Cards {
  std::map<long, Vec3> nodes;
  std::map<long, std::array<long, 4>> shells;
  std::map<long, long> part_of;
  std::map<long, std::array<long, 2>> beams;
};

Cards read_cards(const std::string& text) {
  Cards cards;
  std::istringstream lines(text);
  std::string line, keyword;
  const auto integer = [&](std::size_t column) { return std::stol(line.substr(column, 8)); };
  while (std::getline(lines, line)) {
    if (line.starts_with('$')) continue;
    if (line.starts_with('*'))
      keyword = line;
    else if (keyword == "*NODE") {
      EXPECT_TRUE(
          cards.nodes
              .emplace(integer(0), Vec3(std::stod(line.substr(8, 16)), std::stod(line.substr(24, 16)), std::stod(line.substr(40, 16))))
              .second)
          << "node " << integer(0) << " twice";
    } else if (keyword == "*ELEMENT_SHELL") {
      EXPECT_TRUE(cards.shells.emplace(integer(0), std::array{integer(16), integer(24), integer(32), integer(40)}).second)
          << "shell " << integer(0) << " twice";
      cards.part_of[integer(0)] = integer(8);
    } else if (keyword == "*ELEMENT_BEAM") {
      cards.beams.emplace(integer(0), std::array{integer(16), integer(24)});
    }
  }
  return cards;
}

class SampleSize : public testing::TestWithParam<std::size_t> {};

TEST_P(SampleSize, has_about_the_wanted_number_of_shells) {
  const Cards cards = read_cards(sample_text(GetParam()));
  EXPECT_NEAR(static_cast<double>(cards.shells.size()), static_cast<double>(GetParam()), 0.01 * static_cast<double>(GetParam()));
}

TEST_P(SampleSize, every_shell_names_defined_nodes_and_every_node_is_used) {
  const Cards cards = read_cards(sample_text(GetParam()));
  std::set<long> used;
  for (const auto& [id, corners] : cards.shells) {
    const std::set<long> distinct(corners.begin(), corners.end());
    EXPECT_GE(distinct.size(), 3u) << "shell " << id;
    for (const long node : corners) ASSERT_TRUE(cards.nodes.contains(node)) << "shell " << id << " names node " << node;
    used.insert(corners.begin(), corners.end());
  }
  for (const auto& [id, ends] : cards.beams) used.insert(ends.begin(), ends.end());
  EXPECT_EQ(used.size(), cards.nodes.size());
}

TEST_P(SampleSize, neighbours_agree_on_the_side_they_face) {
  // Two shells of a part run along their common edge in opposite senses.
  const Cards cards = read_cards(sample_text(GetParam()));
  std::map<std::pair<long, long>, int> directed;
  for (const auto& [id, c] : cards.shells) {
    const int corners = c[3] == c[2] ? 3 : 4;
    for (int i = 0; i < corners; ++i) ++directed[{c[static_cast<std::size_t>(i)], c[static_cast<std::size_t>((i + 1) % corners)]}];
  }
  for (const auto& [edge, count] : directed) ASSERT_EQ(count, 1) << "edge " << edge.first << "-" << edge.second;
}

TEST_P(SampleSize, welds_join_sheets_at_the_distance_of_their_thicknesses) {
  const Cards cards = read_cards(sample_text(GetParam()));
  EXPECT_GT(cards.beams.size(), 100u);
  // Half the sum of the two sheets' thicknesses, for the pairs that are welded.
  const std::array expected{1.65, 1.4, 1.5, 1.7, 1.35, 1.15, 1.0};
  for (const auto& [id, ends] : cards.beams) {
    const double length = (cards.nodes.at(ends[1]) - cards.nodes.at(ends[0])).norm();
    double nearest = 1e9;
    for (const double distance : expected) nearest = std::min(nearest, std::abs(distance - length));
    EXPECT_LT(nearest, 0.03) << "weld " << id << " is " << length << " long";
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, SampleSize, testing::Values(2'000, 3'333, 5'000, 10'000, 20'000, 60'000));

TEST(Sample, is_the_same_bytes_on_every_machine) {
  const std::string text = sample_text(5'000);
  EXPECT_EQ(hash128(std::as_bytes(std::span(text))).hex(), "bc1defe058dd942cdfe99eb48e467f9e");
}

TEST(Sample, reads_and_saves_as_a_deck) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / ("prismesh_sample_test." + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  ASSERT_TRUE(write_sample(folder / "sample.k", 5'000));
  const Result<OpenedDeck> opened = open(folder / "sample.k");
  ASSERT_TRUE(opened) << opened.error().text();
  EXPECT_THAT(opened->deck->warnings, testing::IsEmpty());
  const Cards cards = read_cards(sample_text(5'000));
  EXPECT_EQ(opened->model.node_count(), cards.nodes.size());
  EXPECT_EQ(opened->model.shell_count(), cards.shells.size());
  EXPECT_EQ(opened->model.parts->size(), 8u);
  EXPECT_EQ(opened->model.elements[static_cast<std::size_t>(ElementClass::beam)]->size(), cards.beams.size());
  EXPECT_EQ(guess_length_unit(opened->model), LengthUnit::mm);
  ASSERT_TRUE(save(*opened->deck, opened->model, opened->model, folder / "again.k"));
  std::ifstream again(folder / "again.k");
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(again), {}), sample_text(5'000));
  std::filesystem::remove_all(folder);
}

TEST(Sample, sizes_outside_the_limits_are_refused_with_the_limits) {
  for (const std::size_t shells : {std::size_t{1'999}, std::size_t{5'000'001}}) {
    const std::filesystem::path path = std::filesystem::temp_directory_path() / "prismesh_sample_refused.k";
    const Result<void> written = write_sample(path, shells);
    ASSERT_FALSE(written);
    EXPECT_THAT(written.error().message, testing::AllOf(testing::HasSubstr("2000"), testing::HasSubstr("5000000")));
    EXPECT_FALSE(std::filesystem::exists(path));
  }
}

}  // namespace
}  // namespace prismesh::mesh::deck

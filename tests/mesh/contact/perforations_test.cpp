#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "mesh/model/topology_change.h"
#include "tests/mesh/contact/sheets_that_meet.h"

namespace prismesh::mesh::contact {
namespace {

using test::perforations_of;
using test::SheetsThatMeet;

constexpr double kDegree = 3.14159265358979323846 / 180;

/// A plate of 8 x 6 shells, its long sides along x, turned about an axis along x through `at`; `offset`: from its middle row.
SheetsThatMeet plate_and_turned(double degrees, const Vec3& at = {0.03, 0.21, 0}, double offset = 0.37) {
  SheetsThatMeet sheets;
  return sheets.add_plate(1).add(2, 8, 6, [=](int i, int j) {
    const double along = j - 3 + offset;
    return Vec3(at + Vec3(i - 4, along * std::cos(degrees * kDegree), along * std::sin(degrees * kDegree)));
  });
}

TEST(Perforations, of_two_plates_at_angles) {
  for (const double degrees : {5.0, 10.0, 30.0, 45.0, 60.0, 85.0, 90.0}) {
    const auto found = perforations_of(plate_and_turned(degrees));
    ASSERT_EQ(found.size(), 1u) << degrees;
    const Perforation& region = found.front();
    EXPECT_EQ(region.part_a, PartIndex(0));
    EXPECT_EQ(region.part_b, PartIndex(1));
    EXPECT_EQ(region.shells_a.size(), 9u) << "columns of the plate from -4 + 0.03 to 4 + 0.03";
    EXPECT_EQ(region.shells_b.size(), 8u);
    EXPECT_NEAR(region.length, 8, 1e-12);
    for (const CurveSegment& segment : region.curve) {
      EXPECT_NEAR(segment.from.y(), 0.21, 1e-12);
      EXPECT_NEAR(segment.to.y(), 0.21, 1e-12);
      EXPECT_NEAR(segment.to.z(), 0, 1e-12);
      EXPECT_LT(segment.from.x(), segment.to.x());
    }
  }
}

TEST(Perforations, none_where_plates_are_apart_or_only_boxes_meet) {
  EXPECT_TRUE(perforations_of(plate_and_turned(5, {0, 0, 0.3})).empty());
  EXPECT_TRUE(perforations_of(plate_and_turned(90, {0, 0, 2.7})).empty());
}

TEST(Perforations, a_sheet_that_stands_on_another_touches_it) {
  SheetsThatMeet standing;
  standing.add_plate(1).add(2, 8, 3, [](int i, int j) { return Vec3(i - 4 + 0.3, 0.4, j); });
  EXPECT_TRUE(perforations_of(standing).empty());
  SheetsThatMeet on_its_nodes;
  on_its_nodes.add_plate(1).add(2, 8, 3, [](int i, int j) { return Vec3(i - 4, 0, j); });
  EXPECT_TRUE(perforations_of(on_its_nodes).empty());
  SheetsThatMeet through;
  through.add_plate(1).add(2, 8, 3, [](int i, int j) { return Vec3(i - 4 + 0.3, 0.4, j - 0x1p-40); });
  ASSERT_EQ(perforations_of(through).size(), 1u) << "a trillionth is enough";
  EXPECT_NEAR(perforations_of(through).front().length, 8, 1e-9);
}

TEST(Perforations, overlap_in_one_plane_is_none) {
  SheetsThatMeet flat;
  flat.add_plate(1).add(2, 6, 6, [](int i, int j) { return Vec3(i - 3.3, j - 2.6, 0); });
  EXPECT_TRUE(perforations_of(flat).empty());
  SheetsThatMeet same;
  EXPECT_TRUE(perforations_of(same.add_plate(1).add_plate(2)).empty());
}

TEST(Perforations, a_sheet_that_leaves_another_after_lying_in_it_is_none) {
  for (const double beyond : {0.0, 1.0, -1.0})
    for (const double place : {1.0, 0.6}) {
      SheetsThatMeet sheets;
      sheets.add_plate(1).add(2, 3, 4, [=](int i, int j) { return Vec3(j - 1.7, i - place, i == 3 ? 1 : i == 0 ? beyond : 0); });
      EXPECT_TRUE(perforations_of(sheets).empty()) << beyond << " " << place;
    }
}

/// A strip along x that rises on both sides of its middle row (`passing` false), or goes through.
SheetsThatMeet row_on_plate(bool passing, double x, double y) {
  SheetsThatMeet sheets;
  return sheets.add_plate(1).add(2, 4, 2, [=](int i, int j) { return Vec3(i - 2 + x, j - 1 + y, passing ? j - 1 : std::abs(j - 1)); });
}

TEST(Perforations, a_row_of_nodes_on_the_other_sheet_is_decided_on_the_shells_about_it) {
  for (const double x : {0.0, 0.3})
    for (const double y : {0.0, 0.25}) {
      EXPECT_TRUE(perforations_of(row_on_plate(false, x, y)).empty()) << x << " " << y;
      const auto found = perforations_of(row_on_plate(true, x, y));
      ASSERT_EQ(found.size(), 1u) << x << " " << y;
      EXPECT_NEAR(found.front().length, 4, 1e-12) << "each piece once";
      EXPECT_EQ(found.front().shells_b.size(), 8u) << "both rows";
    }
}

TEST(Perforations, rows_of_both_sheets_on_one_line_are_decided_by_angles) {
  // two roofs with one ridge: one inside the other, and one turned on its side
  const auto roofs = [](double first, double second, double third, double fourth) {
    SheetsThatMeet sheets;
    const auto add = [&](std::int64_t part, double left, double right) {
      sheets.add(part, 3, 2, [=](int i, int j) {
        const double degrees = j == 0 ? left : right, size = j == 1 ? 0 : 1;
        return Vec3(i, size * std::cos(degrees * kDegree), size * std::sin(degrees * kDegree));
      });
    };
    add(1, first, second), add(2, third, fourth);
    return perforations_of(sheets);
  };
  EXPECT_TRUE(roofs(200, 340, 220, 320).empty());
  EXPECT_TRUE(roofs(200, 340, 20, 160).empty());
  ASSERT_EQ(roofs(200, 340, 300, 100).size(), 1u);
  EXPECT_NEAR(roofs(200, 340, 300, 100).front().length, 3, 1e-12);
  ASSERT_EQ(roofs(0, 200, 190, 300).size(), 1u);
  EXPECT_TRUE(roofs(0, 200, 210, 300).empty());
  EXPECT_TRUE(roofs(0, 90, 0, 180).empty()) << "half of each lies on the other";
}

TEST(Perforations, a_node_exactly_on_the_other_plane) {
  const auto cone = [](double rim) {
    SheetsThatMeet sheets;
    sheets.add_plate(1).add(2, 2, 2, [=](int i, int j) { return i == 1 && j == 1 ? Vec3(0.2, 0.3, 0) : Vec3(i - 0.8, j - 0.7, rim); });
    return sheets;
  };
  EXPECT_TRUE(perforations_of(cone(1)).empty()) << "the tip touches";
  SheetsThatMeet slope;
  slope.add_plate(1).add(2, 2, 2, [](int i, int j) { return Vec3(i - 0.8, j - 0.7, (i - 1) + 0.5 * (j - 1)); });
  ASSERT_EQ(perforations_of(slope).size(), 1u) << "passes through its middle node";
  EXPECT_NEAR(perforations_of(slope).front().length, std::sqrt(5.0), 1e-12);
}

TEST(Perforations, a_side_through_a_side) {
  // triangles whose sides cross at a point: then they share nothing else, or a piece of a line
  const std::vector<Vec3> flat{{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}};
  const auto crosses = [&](const Vec3& third) {
    std::vector<test::NodeSpec> nodes;
    for (const Vec3& p : flat) nodes.push_back({static_cast<std::int64_t>(nodes.size()) + 1, p});
    for (const Vec3& p : {Vec3(0.1, 0, -1), Vec3(0.1, 0, 1), third}) nodes.push_back({static_cast<std::int64_t>(nodes.size()) + 1, p});
    return perforations_of(test::make_model(nodes, {{1, 1, {1, 2, 3}}, {2, 2, {4, 5, 6}}}));
  };
  EXPECT_TRUE(crosses({0.1, 1, 0}).empty()) << "away from the triangle";
  ASSERT_EQ(crosses({0.1, -0.5, 0}).size(), 1u);
  EXPECT_NEAR(crosses({0.1, -0.5, 0}).front().length, 0.5, 1e-12);
}

TEST(Perforations, of_a_sphere_through_a_plate) {
  constexpr int kAround = 48, kUp = 24;
  constexpr double kRadius = 3, kHeight = 1.2;
  SheetsThatMeet sheets;
  sheets.add_plate(1).add(2, kAround, kUp, [](int i, int j) {
    const double turn = 360.0 * i / kAround * kDegree, up = (-84 + 168.0 * j / kUp) * kDegree;
    return Vec3(kRadius * std::cos(up) * std::cos(turn), kRadius * std::cos(up) * std::sin(turn), kHeight + kRadius * std::sin(up));
  });
  const auto found = perforations_of(sheets);
  ASSERT_EQ(found.size(), 1u);
  const double circle = std::sqrt(kRadius * kRadius - kHeight * kHeight);
  EXPECT_NEAR(found.front().length, 2 * 180 * kDegree * circle, 0.01 * 2 * 180 * kDegree * circle);
  for (const CurveSegment& segment : found.front().curve) EXPECT_NEAR(segment.from.head<2>().norm(), circle, 0.02 * circle);
}

TEST(Perforations, of_a_fold_of_one_part) {
  // a strip that goes out, turns, and comes back through itself
  SheetsThatMeet strip;
  strip.add(1, 12, 4, [](int i, int j) {
    if (i <= 5) return Vec3(i, j, 0);
    if (i == 6) return Vec3(6, j, 1);
    return Vec3(12 - i + 0.5, j, 1.3 - 0.4 * (i - 6));
  });
  const auto found = perforations_of(strip);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found.front().part_a, found.front().part_b);
  EXPECT_NEAR(found.front().length, 4, 1e-12);
  const std::vector<ShellIndex>& a = found.front().shells_a;
  const std::vector<ShellIndex>& b = found.front().shells_b;
  EXPECT_EQ(a.size(), 4u);
  EXPECT_EQ(b.size(), 4u) << "each fold is a side";
}

TEST(Perforations, folds_are_the_sides_whatever_the_order_of_shells) {
  SheetsThatMeet strip;
  strip.add(1, 12, 9, [](int i, int j) {
    if (i <= 5) return Vec3(i, j, 0);
    return i == 6 ? Vec3(6, j, 1) : Vec3(12 - i + 0.5, j, 1.3 - 0.4 * (i - 6));
  });
  std::mt19937 random(11);
  for (int trial = 0; trial < 5; ++trial) {
    std::shuffle(strip.shells.begin(), strip.shells.end(), random);
    const Model model = strip.model();
    const auto found = perforations_of(model);
    ASSERT_EQ(found.size(), 1u);
    const auto heights = [&](const std::vector<ShellIndex>& shells) {
      double sum = 0;
      for (const ShellIndex shell : shells)
        for (const NodeIndex node : model.shell(shell).node) sum += std::abs(model.position(node).z());
      return sum;
    };
    EXPECT_EQ(found.front().shells_a.size(), 9u);
    EXPECT_EQ(found.front().shells_b.size(), 9u);
    EXPECT_EQ(std::min(heights(found.front().shells_a), heights(found.front().shells_b)), 0) << "the flat fold";
  }
}

TEST(Perforations, two_regions_come_longest_first) {
  SheetsThatMeet sheets;
  sheets.add_plate(1);
  sheets.add(3, 2, 2, [](int i, int j) { return Vec3(i - 3.25, 2.25, j - 0.75); });
  sheets.add(2, 4, 2, [](int i, int j) { return Vec3(i - 1.25, -2.25, j - 0.75); });
  sheets.add(2, 2, 2, [](int i, int j) { return Vec3(i + 1.25, 2.25, j - 0.75); });
  const auto found = perforations_of(sheets);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_NEAR(found[0].length, 4, 1e-12);
  EXPECT_EQ(found[1].length, found[2].length) << "then by parts";
  EXPECT_EQ(found[1].part_b, PartIndex(1));
  EXPECT_EQ(found[2].part_b, PartIndex(2));
}

TEST(Perforations, shells_with_a_common_node_do_not_count) {
  const Model model = test::make_shells({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 1, -1}, {1.2, 0.4, 1}}, {{0, 1, 2, 2}, {0, 3, 4, 4}});
  EXPECT_TRUE(perforations_of(model).empty());
}

TEST(Perforations, shells_that_have_no_area_or_are_not_finite_are_left_out) {
  const double nan = std::nan(""), infinite = std::numeric_limits<double>::infinity();
  for (const Vec3& spoiled : {Vec3(nan, 0, 0), Vec3(0, infinite, 0), Vec3(-infinite, nan, 1)}) {
    SheetsThatMeet sheets = plate_and_turned(60);
    sheets.nodes[5 + 11 * 5].position = spoiled;  // corner of four shells of the plate; two of them cross
    sheets.nodes[4 + 11 * 5].position = spoiled;
    const auto found = perforations_of(sheets);
    double length = 0;
    for (const Perforation& region : found) length += region.length;
    EXPECT_GT(length, 4);
    EXPECT_LT(length, 8);
  }
  SheetsThatMeet needle;
  needle.add_plate(1).add(2, 1, 1, [](int i, int j) { return Vec3(0.3, 0.3, i + j - 0.5); });
  EXPECT_TRUE(perforations_of(needle).empty());
}

TEST(Perforations, removed_shells_are_left_out) {
  Model model = plate_and_turned(60).model();
  for (std::size_t s = 100; s < model.shell_count(); ++s) remove_shell(model, ShellIndex(s));
  model.adjacency = std::make_shared<const Adjacency>(build_adjacency(model));
  EXPECT_TRUE(perforations_of(model).empty());
}

/// Sheets on the grid of 2^-20, which wave through each other and meet in nodes and rows.
SheetsThatMeet waves(std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto on_grid = [&](double size) { return std::round(std::uniform_real_distribution<double>(-size, size)(random) * 4) / 4; };
  SheetsThatMeet sheets;
  for (int part = 1; part <= 4; ++part)
    sheets.add(part, 12, 12, [&](int i, int j) { return Vec3(i + on_grid(0.3), j + on_grid(0.3), on_grid(0.6)); });
  for (test::NodeSpec& node : sheets.nodes)
    if (random() % 3 == 0) node.position += Vec3(on_grid(1), on_grid(2), on_grid(1)) * 0x1p-18;
  return sheets;
}

void expect_same(const std::vector<Perforation>& a, const std::vector<Perforation>& b, double tolerance) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t r = 0; r < a.size(); ++r) {
    EXPECT_EQ(a[r].part_a, b[r].part_a);
    EXPECT_EQ(a[r].part_b, b[r].part_b);
    EXPECT_EQ(a[r].shells_a, b[r].shells_a);
    EXPECT_EQ(a[r].shells_b, b[r].shells_b);
    EXPECT_NEAR(a[r].length, b[r].length, tolerance);
  }
}

TEST(Perforations, do_not_change_with_a_shift_on_the_grid) {
  SheetsThatMeet sheets = waves(3);
  const auto before = find_shell_crossings(sheets.model(), spatial::BoxTree(sheets.model()));
  ASSERT_GT(before.size(), 200u);
  for (test::NodeSpec& node : sheets.nodes) node.position += Vec3(123456 + 3 * 0x1p-20, -98765, 0x1p-20);
  const auto after = find_shell_crossings(sheets.model(), spatial::BoxTree(sheets.model()));
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(before[i].a, after[i].a);
    EXPECT_EQ(before[i].b, after[i].b);
    EXPECT_EQ(before[i].segments.size(), after[i].segments.size());
  }
}

TEST(Perforations, do_not_depend_on_the_order_of_the_parts) {
  SheetsThatMeet sheets = plate_and_turned(30);
  const auto before = perforations_of(sheets);
  for (test::ShellSpec& shell : sheets.shells) shell.part = 3 - shell.part;
  const auto after = perforations_of(sheets);
  ASSERT_EQ(after.size(), 1u);
  EXPECT_EQ(before.front().shells_a, after.front().shells_b);
  EXPECT_EQ(before.front().length, after.front().length);
}

TEST(Perforations, are_the_same_with_any_number_of_threads) {
  const Model model = waves(5).model();
  const auto with_threads = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return perforations_of(model);
  };
  const auto one = with_threads(1);
  ASSERT_FALSE(one.empty());
  expect_same(one, with_threads(4), 0);
}

}  // namespace
}  // namespace prismesh::mesh::contact

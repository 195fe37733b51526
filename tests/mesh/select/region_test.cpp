#include "mesh/select/region.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "base/deterministic_math.h"
#include "mesh/model/topology_change.h"
#include "tests/support/make_model.h"

namespace prismesh::mesh::select {
namespace {

using test::grid_node;
using test::make_grid;

Model flat_grid(int columns, int rows) {
  return make_grid(columns, rows, [](int i, int j) { return Vec3(i, j, 0); });
}

ShellSet region_at(const Model& model, NodeIndex start, double angle, OutOfSight out_of_sight = {}) {
  return region(model, shells_at(model, start, out_of_sight), {RegionBound::features, angle, out_of_sight, nullptr});
}

TEST(Region, stops_at_creases_sharper_than_the_angle) {
  // a plate folded by 40 degrees at x = 3 and by 20 at x = 6
  const double fold = 40 * 3.14159265358979 / 180;
  const Model model = make_grid(9, 2, [&](int i, int j) {
    const double a = std::min(i, 3);
    const double b = std::clamp(i - 3, 0, 3);
    const double c = std::max(i - 6, 0);
    return Vec3(a + b * std::cos(fold) + c * std::cos(1.5 * fold), j, b * std::sin(fold) + c * std::sin(1.5 * fold));
  });
  EXPECT_EQ(region_at(model, grid_node(9, 1, 1), 30).size(), 6u);
  EXPECT_EQ(region_at(model, grid_node(9, 4, 1), 30).size(), 12u);
  EXPECT_EQ(region_at(model, grid_node(9, 4, 1), 10).size(), 6u);
  EXPECT_EQ(region_at(model, grid_node(9, 4, 1), 45).size(), 18u);
  // on the crease: both sides
  EXPECT_EQ(region_at(model, grid_node(9, 3, 1), 30).size(), 18u);
}

TEST(Region, stops_at_junctions_and_needs_shells) {
  // a web stands on a flat sheet along node 2-3: three shells at that edge
  const Model model = test::make_model({{1, {0, 0, 0}},
                                        {2, {1, 0, 0}},
                                        {3, {1, 1, 0}},
                                        {4, {0, 1, 0}},
                                        {5, {2, 0, 0}},
                                        {6, {2, 1, 0}},
                                        {7, {1, 0, 1}},
                                        {8, {1, 1, 1}},
                                        {9, {7, 7, 7}}},
                                       {{1, 1, {1, 2, 3, 4}}, {2, 1, {2, 5, 6, 3}}, {3, 1, {2, 7, 8, 3}}});
  EXPECT_EQ(region_at(model, NodeIndex(0), 30), ShellSet{ShellIndex(0)});
  EXPECT_TRUE(region_at(model, NodeIndex(8), 30).empty());
  EXPECT_TRUE(region_at(model, NodeIndex(), 30).empty());
}

/// A roof of two slopes of 4 x 6 shells, 50 degrees apart, whose shells' node order is turned over where `turned` says so.
Model roof(const std::function<bool(int, int)>& turned) {
  std::vector<Vec3> points;
  std::vector<std::array<int, 4>> shells;
  for (int j = 0; j <= 6; ++j)
    for (int i = 0; i <= 8; ++i) points.emplace_back(i, j, -std::abs(i - 4) * 0.4663);  // tan 25 degrees
  for (int j = 0; j < 6; ++j)
    for (int i = 0; i < 8; ++i) {
      const int corner = i + 9 * j;
      if (turned(i, j))
        shells.push_back({corner, corner + 9, corner + 10, corner + 1});
      else
        shells.push_back({corner, corner + 1, corner + 10, corner + 9});
    }
  return test::make_shells(points, shells);
}

TEST(Region, does_not_ask_normals) {
  for (const bool mixed : {false, true}) {
    const Model model = roof([&](int i, int j) { return mixed && (i * 7 + j * 5) % 3 == 0; });
    EXPECT_EQ(region_at(model, NodeIndex(9 * 3 + 1), 45).size(), 24u);
    EXPECT_EQ(region_at(model, NodeIndex(9 * 3 + 1), 55).size(), 48u);
  }
}

/// Two strips of 6 shells side by side, the second turned up by `degrees`; between them a row of shells of width `gap`, turned up by
/// `noise` degrees alone. Every second shell's node order is turned over; with `turned_beyond`, the other ones' of the second strip.
Model strips_with_slivers(double degrees, double gap, double noise, bool turned_beyond = false) {
  std::vector<Vec3> points;
  std::vector<std::array<int, 4>> shells;
  const auto turned = [](double angle) { return Vec3(deterministic_cos_degrees(angle), 0, deterministic_sin_degrees(angle)); };
  for (int j = 0; j <= 6; ++j) {
    const Vec3 edge(1, j, 0), beyond = edge + gap * turned(noise);
    for (const Vec3& point : {Vec3(0, j, 0), edge, beyond, Vec3(beyond + turned(degrees))}) points.push_back(point);
  }
  for (int j = 0; j < 6; ++j)
    for (int i = 0; i < 3; ++i) {
      const int corner = i + 4 * j;
      if (((i + j) % 2 == 0) != (turned_beyond && i == 2))
        shells.push_back({corner, corner + 1, corner + 5, corner + 4});
      else
        shells.push_back({corner, corner + 4, corner + 5, corner + 1});
    }
  return test::make_shells(points, shells);
}

TEST(Region, looks_through_slivers) {
  for (const double gap : {1e-3, 1e-9, 0.0})
    for (const double noise : {0.0, 70.0, 170.0}) {
      EXPECT_EQ(region_at(strips_with_slivers(10, gap, noise), NodeIndex(4), 30).size(), 18u) << gap << " " << noise;
      // the sliver belongs to what it was reached from, the crease behind it still ends the region
      EXPECT_EQ(region_at(strips_with_slivers(80, gap, noise), NodeIndex(4), 30).size(), 12u) << gap << " " << noise;
      EXPECT_EQ(region_at(strips_with_slivers(80, gap, noise), NodeIndex(7), 30).size(), 12u) << gap << " " << noise;
    }
  // wide enough to have a plane of its own: a two-hundredth of its length
  EXPECT_EQ(region_at(strips_with_slivers(10, 0.1, 70), NodeIndex(4), 30).size(), 6u);
  EXPECT_EQ(region_at(strips_with_slivers(10, 1.1 / 200, 70), NodeIndex(4), 30).size(), 6u);
  EXPECT_EQ(region_at(strips_with_slivers(10, 0.9 / 200, 70), NodeIndex(4), 30).size(), 18u);
}

TEST(Region, looks_through_slivers_whichever_way_the_shells_beyond_are_turned) {
  EXPECT_EQ(region_at(strips_with_slivers(10, 1e-3, 0, true), NodeIndex(4), 30).size(), 18u);
  EXPECT_EQ(region_at(strips_with_slivers(80, 1e-3, 0, true), NodeIndex(4), 30).size(), 12u);
  EXPECT_EQ(region_at(strips_with_slivers(170, 1e-3, 0, true), NodeIndex(4), 30).size(), 12u);
}

TEST(Region, begins_at_the_side_of_the_crease_that_is_closest) {
  const Model model = roof([](int, int) { return false; });
  const auto at = [&](const Vec3& point) { return region(model, shells_near(model, point, {}), {RegionBound::features, 30, {}, nullptr}); };
  EXPECT_EQ(at(Vec3(3.9, 2.5, 0)).size(), 24u);
  EXPECT_EQ(at(Vec3(3.9, 2.5, 0)).front(), ShellIndex(0));
  EXPECT_EQ(at(Vec3(4.1, 2.5, 0)).front(), ShellIndex(4));
  EXPECT_EQ(at(Vec3(4, 2.5, 9)).size(), 48u) << "on the crease: both sides";
  EXPECT_EQ(shells_near(model, Vec3(4, 3, 0), {}).size(), 4u) << "at a node: all around it";
  EXPECT_EQ(shells_near(model, Vec3(2.3, 3, 0.5), {}).size(), 2u) << "above the line between two rows";
}

TEST(Region, begins_on_all_shells_that_are_as_close_within_a_thousandth_of_their_size) {
  const Model model = flat_grid(4, 4);
  const double thousand = 1000, height = 0.2;
  // over the second column, so far from its border that the first is farther by this share of a shell's side
  const auto columns_at = [&](double farther, double scale) {
    Model scaled = model;
    for (std::size_t n = 0; n < scaled.node_count(); ++n) scaled.positions.set(n, Vec3(scale * model.positions[n]));
    const double across = std::sqrt((height + farther) * (height + farther) - height * height);
    return shells_near(scaled, Vec3(scale * Vec3(1 + across, 1.5, height)), {}).size();
  };
  for (const double scale : {1.0, thousand}) {
    EXPECT_EQ(columns_at(0.5e-3, scale), 2u) << scale;
    EXPECT_EQ(columns_at(2e-3, scale), 1u) << scale;
  }
}

TEST(Region, ends_with_the_part_or_the_piece) {
  // parts 1 and 2 share an edge, part 3 touches part 2 in a node only, part 1 has a second piece
  std::vector<test::NodeSpec> nodes;
  for (int j = 0; j <= 2; ++j)
    for (int i = 0; i <= 5; ++i) nodes.push_back({1 + i + 10 * j, Vec3(i, j, 0)});
  const Model model =
      test::make_model(nodes, {{1, 1, {1, 2, 12, 11}}, {2, 2, {2, 3, 13, 12}}, {3, 3, {13, 14, 24, 23}}, {4, 1, {5, 6, 16, 15}}});
  const auto grown = [&](RegionBound bound, const connections::JoinedSheets* across, OutOfSight out = {}) {
    return region(model, shells_at(model, NodeIndex(0), out), {bound, 30, out, across});
  };
  const connections::JoinedSheets none;
  EXPECT_EQ(grown(RegionBound::part, nullptr), (ShellSet{ShellIndex(0), ShellIndex(3)}));
  EXPECT_EQ(grown(RegionBound::piece, nullptr), (ShellSet{ShellIndex(0), ShellIndex(1)}));
  EXPECT_EQ(grown(RegionBound::piece, &none), (ShellSet{ShellIndex(0), ShellIndex(1), ShellIndex(2)})) << "a shared node is a weld";
  EXPECT_EQ(grown(RegionBound::part, &none).size(), 4u);
  const std::vector<std::uint8_t> second_hidden{0, 1, 0};
  EXPECT_EQ(grown(RegionBound::piece, &none, second_hidden), ShellSet{ShellIndex(0)});
  EXPECT_EQ(grown(RegionBound::part, &none, second_hidden).size(), 2u);
}

/// Shells in a row, one of each part from 1 on, or of the parts given.
Model row_of_parts(const std::vector<std::int64_t>& parts) {
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  const auto count = static_cast<std::int64_t>(parts.size());
  for (std::int64_t i = 0; i <= count; ++i)
    for (const std::int64_t j : {0, 1}) nodes.push_back({1 + i + 100 * j, Vec3(static_cast<double>(i), static_cast<double>(j), 0)});
  for (std::int64_t i = 0; i < count; ++i) shells.push_back({1 + i, parts[static_cast<std::size_t>(i)], {1 + i, 2 + i, 102 + i, 101 + i}});
  return test::make_model(nodes, shells);
}

TEST(Region, of_parts_goes_on_from_part_to_part_in_whatever_order_they_stand) {
  const Model model = row_of_parts({1, 2, 3, 4});
  const connections::JoinedSheets none;
  for (const std::size_t start : {0U, 1U, 3U})
    EXPECT_EQ(region(model, {ShellIndex(start)}, {RegionBound::part, 30, {}, &none}).size(), 4u) << start;
}

TEST(Region, takes_no_hidden_shell_wherever_it_begins) {
  const Model model = row_of_parts({1, 2, 2, 1});
  const std::vector<std::uint8_t> second_hidden{0, 1};
  const ShellSet all{ShellIndex(0), ShellIndex(1), ShellIndex(2), ShellIndex(3)};
  for (const RegionBound bound : {RegionBound::features, RegionBound::part, RegionBound::piece})
    EXPECT_EQ(region(model, all, {bound, 30, second_hidden, nullptr}), (ShellSet{ShellIndex(0), ShellIndex(3)}));
  EXPECT_EQ(shells_at(model, model.find_node(2), second_hidden), ShellSet{ShellIndex(0)});
}

TEST(Region, takes_a_hidden_web_for_not_there) {
  // a web of part 2 stands where two shells of part 1 meet
  const Model model = test::make_model(
      {{1, {0, 0, 0}}, {2, {1, 0, 0}}, {3, {1, 1, 0}}, {4, {0, 1, 0}}, {5, {2, 0, 0}}, {6, {2, 1, 0}}, {7, {1, 0, 1}}, {8, {1, 1, 1}}},
      {{1, 1, {1, 2, 3, 4}}, {2, 1, {2, 5, 6, 3}}, {3, 2, {2, 7, 8, 3}}});
  const std::vector<std::uint8_t> web_hidden{0, 1};
  EXPECT_EQ(region_at(model, NodeIndex(0), 30, web_hidden).size(), 2u);
  EXPECT_EQ(region_at(model, NodeIndex(0), 30).size(), 1u);
}

TEST(Region, begins_on_what_is_in_sight_where_something_hidden_is_nearer) {
  // a hidden sheet of part 2 with finer shells right above one of part 1
  std::vector<test::NodeSpec> nodes;
  for (int k = 0; k < 4; ++k) nodes.push_back({1 + k, Vec3(10 * (k == 1 || k == 2), 10 * (k > 1), 0)});
  for (int k = 0; k < 4; ++k) nodes.push_back({11 + k, Vec3(4 + (k == 1 || k == 2), 4 + (k > 1), 1)});
  const Model model = test::make_model(nodes, {{1, 1, {1, 2, 3, 4}}, {2, 2, {11, 12, 13, 14}}});
  const std::vector<std::uint8_t> second_hidden{0, 1};
  EXPECT_EQ(shells_near(model, Vec3(4.5, 4.5, 1), {}), ShellSet{ShellIndex(1)});
  EXPECT_EQ(shells_near(model, Vec3(4.5, 4.5, 1), second_hidden), ShellSet{ShellIndex(0)});
}

/// A grid whose corner shell and corner node are removed.
Model without_a_corner() {
  Model model = flat_grid(3, 3);
  remove_shell(model, ShellIndex(0));
  remove_node(model, NodeIndex(0));
  model.adjacency = std::make_shared<const Adjacency>(build_adjacency(model));
  return model;
}

TEST(NearestNode, is_none_that_was_removed) { EXPECT_NE(nearest_node(without_a_corner(), Vec3(0, 0, 0)), NodeIndex(0)); }

TEST(Invert, selects_nothing_that_was_removed) {
  const NodeSet rest = invert(without_a_corner(), {NodeIndex(5)});
  EXPECT_EQ(rest.size(), 14u);
  EXPECT_NE(rest.front(), NodeIndex(0));
}

TEST(Welds, lead_from_sheet_to_sheet) {
  // three sheets of 4 shells each over one another; the second is joined to both others
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  for (int sheet = 0; sheet < 3; ++sheet)
    for (int i = 0; i <= 4; ++i)
      for (int j = 0; j <= 1; ++j) nodes.push_back({1 + 100 * sheet + i + 10 * j, Vec3(5.0 * i, 5.0 * j, 1.5 * sheet)});
  for (int sheet = 0; sheet < 3; ++sheet)
    for (int i = 0; i < 4; ++i) {
      const std::int64_t a = 1 + 100 * sheet + i;
      shells.push_back({a, 1 + sheet, {a, a + 1, a + 11, a + 10}});
    }
  const Model model = test::make_model(nodes, shells);
  const connections::JoinedSheets joined({{ShellIndex(1), ShellIndex(5)}, {ShellIndex(10), ShellIndex(7)}},
                                         {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2});
  const auto grown = [&](RegionBound bound, const connections::JoinedSheets* across) {
    return region(model, {ShellIndex(0)}, {bound, 30, {}, across}).size();
  };
  for (const RegionBound bound : {RegionBound::features, RegionBound::creases, RegionBound::part, RegionBound::piece}) {
    EXPECT_EQ(grown(bound, &joined), 12u);
    EXPECT_EQ(grown(bound, nullptr), 4u);
  }
}

TEST(Welds, lead_over_junctions_too) {
  // the web of the junction test, asked for across welds
  const Model model = test::make_model(
      {{1, {0, 0, 0}}, {2, {1, 0, 0}}, {3, {1, 1, 0}}, {4, {0, 1, 0}}, {5, {2, 0, 0}}, {6, {2, 1, 0}}, {7, {1, 0, 1}}, {8, {1, 1, 1}}},
      {{1, 1, {1, 2, 3, 4}}, {2, 1, {2, 5, 6, 3}}, {3, 1, {2, 7, 8, 3}}});
  const connections::JoinedSheets none;
  EXPECT_EQ(region(model, {ShellIndex(0)}, {RegionBound::features, 30, {}, &none}).size(), 3u);
  EXPECT_EQ(region(model, {ShellIndex(0)}, {RegionBound::features, 30, {}, nullptr}).size(), 1u);
}

TEST(NearestNode, finds_it_and_prefers_the_first_of_equals) {
  const Model model = flat_grid(100, 90);
  EXPECT_EQ(nearest_node(model, Vec3(41.2, 17.4, 3)), grid_node(100, 41, 17));
  EXPECT_EQ(nearest_node(model, Vec3(0.5, 0, 0)), grid_node(100, 0, 0));
  EXPECT_EQ(nearest_node(model, Vec3(-1e9, 0, 0)), grid_node(100, 0, 0));
  EXPECT_FALSE(nearest_node(test::make_model({}, {}), Vec3(0, 0, 0)).valid());
}

TEST(Rings, grow_and_shrink_undo_each_other_inside_a_sheet) {
  const Model model = flat_grid(30, 30);
  const NodeSet one{grid_node(30, 15, 15)};
  const NodeSet grown = grow(model, one, 3);
  EXPECT_EQ(grown.size(), 49u);
  EXPECT_TRUE(std::is_sorted(grown.begin(), grown.end()));
  EXPECT_EQ(shrink(model, grown, 3), one);
  EXPECT_EQ(grow(model, grow(model, one, 1), 2), grown);
  EXPECT_TRUE(shrink(model, grown, 4).empty());
  EXPECT_EQ(grow(model, one, 0), one);
}

TEST(Rings, end_at_the_sheets_own_boundary) {
  const Model model = flat_grid(6, 6);
  EXPECT_EQ(grow(model, {grid_node(6, 0, 0)}, 100).size(), 49u);
  NodeSet left;
  for (int j = 0; j <= 6; ++j)
    for (int i = 0; i <= 3; ++i) left.push_back(grid_node(6, i, j));
  EXPECT_EQ(shrink(model, left, 1).size(), 21u);
  EXPECT_EQ(shrink(model, grow(model, left, 3), 5).size(), 49u) << "all is selected: there is no rim";
}

TEST(Rings, of_shells_leave_holes_open) {
  // a ring of 8 shells around one that isn't selected: all its corners are selected nodes, but it isn't
  const Model model = flat_grid(7, 7);
  ShellSet ring;
  for (int j = 2; j <= 4; ++j)
    for (int i = 2; i <= 4; ++i)
      if (i != 3 || j != 3) ring.emplace_back(static_cast<std::size_t>(i + 7 * j));
  EXPECT_TRUE(shrink_shells(model, ring, 1).empty()) << "each of them touches the hole or what is outside";
  const ShellSet grown = grow_shells(model, ring, 1);
  EXPECT_EQ(grown.size(), 25u);
  EXPECT_EQ(shrink_shells(model, grown, 1).size(), 9u);
  EXPECT_EQ(shrink_shells(model, grow_shells(model, {ShellIndex(24)}, 2), 2), ShellSet{ShellIndex(24)});
}

TEST(Rings, take_hidden_shells_for_not_there) {
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  for (int j = 0; j <= 1; ++j)
    for (int i = 0; i <= 6; ++i) nodes.push_back({1 + i + 10 * j, Vec3(i, j, 0)});
  for (int i = 0; i < 6; ++i) shells.push_back({1 + i, 1 + (i == 3), {1 + i, 2 + i, 12 + i, 11 + i}});
  const Model model = test::make_model(nodes, shells);
  const std::vector<std::uint8_t> middle_hidden{0, 1};
  EXPECT_EQ(grow(model, {NodeIndex(0)}, 9, middle_hidden).size(), 8u);
  EXPECT_EQ(grow_shells(model, {ShellIndex(0)}, 9, middle_hidden).size(), 3u);
  // what is in sight of the left side is selected whole: nothing there is rim
  const NodeSet left = grow(model, {NodeIndex(0)}, 9, middle_hidden);
  EXPECT_EQ(shrink(model, left, 1, middle_hidden), left);
  EXPECT_EQ(shrink(model, left, 1).size(), 6u);
  EXPECT_EQ(shrink_shells(model, {ShellIndex(0), ShellIndex(1), ShellIndex(2)}, 1, middle_hidden).size(), 3u);
  EXPECT_EQ(shrink_shells(model, {ShellIndex(0), ShellIndex(1), ShellIndex(2)}, 1).size(), 2u);
}

TEST(Invert, swaps_selected_and_unselected) {
  const Model model = flat_grid(6, 6);
  const NodeSet some{NodeIndex(0), NodeIndex(5), NodeIndex(48)};
  const NodeSet rest = invert(model, some);
  EXPECT_EQ(rest.size(), 46u);
  EXPECT_EQ(invert(model, rest), some);
  EXPECT_EQ(invert(model, {}).size(), 49u);
}

}  // namespace
}  // namespace prismesh::mesh::select

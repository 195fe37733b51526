#include "mesh/select/loops.h"

#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "base/deterministic_math.h"
#include "mesh/select/region.h"
#include "tests/support/make_model.h"

namespace prismesh::mesh::select {
namespace {

using test::grid_node;
using Ids = std::vector<std::int64_t>;

Ids loop_ids(const Model& model, NodeIndex at, OutOfSight out_of_sight = {}) {
  Ids ids;
  for (const NodeIndex node : free_edge_loop(model, shells_at(model, at, out_of_sight), model.position(at), out_of_sight))
    ids.push_back(model.node_ids[node.value]);
  return ids;
}

/// 9 x 9 shells without the middle one.
Model plate_with_hole() {
  return test::make_grid(
      9, 9, [](int i, int j) { return Vec3(i, j, 0); }, [](int i, int j) { return i != 4 || j != 4; });
}

TEST(FreeEdgeLoop, is_the_one_nearest_along_the_surface) {
  const Model model = plate_with_hole();
  EXPECT_EQ(loop_ids(model, grid_node(9, 3, 3)), (Ids{45, 46, 55, 56})) << "the hole";
  EXPECT_EQ(loop_ids(model, grid_node(9, 4, 5)), (Ids{45, 46, 55, 56})) << "from a node of the hole";
  EXPECT_EQ(loop_ids(model, grid_node(9, 1, 4)).size(), 36u) << "the whole border, round its corners";
  EXPECT_EQ(loop_ids(model, grid_node(9, 0, 0)).size(), 36u);
}

TEST(FreeEdgeLoop, does_not_jump_to_a_sheet_that_is_near) {
  // a second sheet just above the middle of the plate, its border nearer than the plate's own
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  for (int j = 0; j <= 8; ++j)
    for (int i = 0; i <= 8; ++i) nodes.push_back({1 + i + 9 * j, Vec3(i, j, 0)});
  for (int j = 0; j < 8; ++j)
    for (int i = 0; i < 8; ++i) shells.push_back({1 + i + 8 * j, 1, {1 + i + 9 * j, 2 + i + 9 * j, 11 + i + 9 * j, 10 + i + 9 * j}});
  for (int k = 0; k < 4; ++k) nodes.push_back({1001 + k, Vec3(3.6 + (k == 1 || k == 2), 3.6 + (k > 1), 0.1)});
  shells.push_back({1001, 2, {1001, 1002, 1003, 1004}});
  const Model model = test::make_model(nodes, shells);
  EXPECT_EQ(loop_ids(model, grid_node(8, 4, 4)).size(), 32u);
}

TEST(FreeEdgeLoop, of_a_closed_sheet_is_empty) {
  std::vector<Vec3> points;
  for (int k = 0; k < 8; ++k) points.emplace_back(k & 1, k >> 1 & 1, k >> 2);
  const Model model = test::make_shells(points, {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}});
  EXPECT_TRUE(loop_ids(model, NodeIndex(0)).empty());
}

TEST(FreeEdgeLoop, stays_with_its_sheet_at_a_bow_tie_corner) {
  // two squares of 2 x 2 shells that share node 13 only
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  for (int j = 0; j <= 4; ++j)
    for (int i = 0; i <= 4; ++i) nodes.push_back({1 + i + 5 * j, Vec3(i, j, 0)});
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i)
      if ((i < 2) == (j < 2)) shells.push_back({1 + i + 4 * j, 1, {1 + i + 5 * j, 2 + i + 5 * j, 7 + i + 5 * j, 6 + i + 5 * j}});
  const Model model = test::make_model(nodes, shells);
  EXPECT_EQ(loop_ids(model, NodeIndex(0)), (Ids{1, 2, 3, 6, 8, 11, 12, 13}));
  EXPECT_EQ(loop_ids(model, NodeIndex(24)), (Ids{13, 14, 15, 18, 20, 23, 24, 25}));
}

/// A flange of 4 x 2 shells; a web stands on its middle line, from end to end or, `inner`, one shell short of both.
Model flange_and_web(bool inner) {
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  for (int j = 0; j <= 2; ++j)
    for (int i = 0; i <= 4; ++i) nodes.push_back({1 + i + 10 * j, Vec3(i, j, 0)});
  for (int i = 0; i <= 4; ++i) nodes.push_back({101 + i, Vec3(i, 1, 1)});
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 4; ++i) shells.push_back({1 + i + 4 * j, 1, {1 + i + 10 * j, 2 + i + 10 * j, 12 + i + 10 * j, 11 + i + 10 * j}});
  for (int i = 0; i < 4; ++i)
    if (!inner || i == 1 || i == 2) shells.push_back({101 + i, 2, {11 + i, 12 + i, 102 + i, 101 + i}});
  return test::make_model(nodes, shells);
}

TEST(FreeEdgeLoop, goes_straight_on_where_it_forks) {
  for (const bool inner : {false, true}) {
    const Model model = flange_and_web(inner);
    EXPECT_EQ(loop_ids(model, NodeIndex(0)), (Ids{1, 2, 3, 4, 5, 11, 15, 21, 22, 23, 24, 25})) << inner;
    // the web's own line ends at the flange
    const NodeIndex web = model.find_node(103);
    EXPECT_EQ(loop_ids(model, web), inner ? (Ids{12, 14, 102, 103, 104}) : (Ids{11, 15, 101, 102, 103, 104, 105})) << inner;
  }
}

TEST(FreeEdgeLoop, goes_on_over_a_junction_into_a_bend_of_less_than_45_degrees_only) {
  const auto loop_bent_by = [](double degrees) {
    const double c = deterministic_cos_degrees(degrees), s = deterministic_sin_degrees(degrees);
    // a shell, one beyond that is bent up, and a web that hangs down at their junction
    const Model model =
        test::make_shells({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1 + c, 0, s}, {1 + c, 1, s}, {1, 0, -1}, {1, 1, -1}},
                          {{0, 1, 2, 3}, {1, 4, 5, 2}, {1, 6, 7, 2}});
    return loop_ids(model, NodeIndex(0));
  };
  EXPECT_EQ(loop_bent_by(40), (Ids{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(loop_bent_by(50), (Ids{1, 2, 3, 4}));
}

TEST(FreeEdgeLoop, ends_where_the_next_shell_is_hidden_and_takes_mid_side_nodes) {
  std::vector<test::NodeSpec> nodes{{1, {0, 0, 0}},  {2, {1, 0, 0}},    {3, {2, 0, 0}},    {11, {0, 1, 0}},   {12, {1, 1, 0}},
                                    {13, {2, 1, 0}}, {50, {0.5, 0, 0}}, {51, {1, 0.5, 0}}, {52, {0.5, 1, 0}}, {53, {0, 0.5, 0}}};
  Model model = test::make_model(nodes, {{1, 1, {1, 2, 12, 11}}, {2, 2, {2, 3, 13, 12}}});
  EXPECT_EQ(loop_ids(model, NodeIndex(0)), (Ids{1, 2, 3, 11, 12, 13}));
  auto midside = std::make_shared<std::vector<MidsideNodes>>();
  midside->push_back({ShellIndex(0), {model.find_node(50), model.find_node(51), model.find_node(52), model.find_node(53)}});
  model.midside = midside;
  const std::vector<std::uint8_t> second_hidden{0, 1};
  EXPECT_EQ(loop_ids(model, NodeIndex(0), second_hidden), (Ids{1, 2, 11, 12, 50, 52, 53}));
}

TEST(FreeEdgeLoop, does_not_go_over_a_junction_onto_a_hidden_shell) {
  // two shells in a plane, of parts 1 and 2, and a web of part 3 at their edge
  std::vector<test::NodeSpec> nodes{{1, {0, 0, 0}}, {2, {1, 0, 0}}, {3, {1, 1, 0}},  {4, {0, 1, 0}},
                                    {5, {2, 0, 0}}, {6, {2, 1, 0}}, {7, {1, 0, -1}}, {8, {1, 1, -1}}};
  const Model model = test::make_model(nodes, {{1, 1, {1, 2, 3, 4}}, {2, 2, {2, 5, 6, 3}}, {3, 3, {2, 7, 8, 3}}});
  const std::vector<std::uint8_t> second_hidden{0, 1, 0};
  EXPECT_EQ(loop_ids(model, NodeIndex(0)), (Ids{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(loop_ids(model, NodeIndex(0), second_hidden), (Ids{1, 2, 3, 4}));
}

TEST(FreeEdgeLoop, is_not_looked_for_beyond_hidden_shells_nor_on_them) {
  // part 1 in the middle, a ring of part 2, another of part 3 at the border
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  for (int j = 0; j <= 5; ++j)
    for (int i = 0; i <= 5; ++i) nodes.push_back({1 + i + 6 * j, Vec3(i, j, 0)});
  for (int j = 0; j < 5; ++j)
    for (int i = 0; i < 5; ++i) {
      const int ring = std::max(std::abs(i - 2), std::abs(j - 2));
      shells.push_back({1 + i + 5 * j, 1 + ring, {1 + i + 6 * j, 2 + i + 6 * j, 8 + i + 6 * j, 7 + i + 6 * j}});
    }
  const Model model = test::make_model(nodes, shells);
  const auto from_the_middle = [&](const std::vector<std::uint8_t>& hidden) {
    return free_edge_loop(model, {ShellIndex(12)}, Vec3(2.5, 2.5, 0), hidden).size();
  };
  EXPECT_EQ(from_the_middle({}), 20u);
  EXPECT_EQ(from_the_middle({0, 1, 0}), 0u);
  EXPECT_EQ(from_the_middle({0, 0, 1}), 0u);
}

TEST(FreeEdgeLoop, is_that_of_the_shells_in_sight_also_where_a_hidden_free_edge_is_nearer) {
  const Model model = test::make_model({{1, {0, 0, 0}}, {2, {1, 0, 0}}, {3, {2, 0, 0}}, {11, {0, 1, 0}}, {12, {1, 1, 0}}, {13, {2, 1, 0}}},
                                       {{1, 1, {1, 2, 12, 11}}, {2, 2, {2, 3, 13, 12}}});
  const std::vector<std::uint8_t> second_hidden{0, 1};
  Ids ids;
  for (const NodeIndex node : free_edge_loop(model, {ShellIndex(0)}, Vec3(1.4, -0.1, 0), second_hidden))
    ids.push_back(model.node_ids[node.value]);
  EXPECT_EQ(ids, (Ids{1, 2, 11, 12}));
}

TEST(FreeEdgeLoop, of_several_at_a_node_is_the_one_nearest_to_the_place) {
  // two shells that share node 3 only
  const Model model =
      test::make_shells({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}}, {{0, 1, 2, 3}, {2, 4, 5, 6}});
  for (const auto& [place, first] : {std::pair(Vec3(0.9, 0.8, 0), std::size_t{0}), std::pair(Vec3(1.1, 1.2, 0), std::size_t{2})}) {
    const NodeSet loop = free_edge_loop(model, {ShellIndex(0), ShellIndex(1)}, place, {});
    ASSERT_EQ(loop.size(), 4u);
    EXPECT_EQ(loop.front(), NodeIndex(first));
  }
}

}  // namespace
}  // namespace prismesh::mesh::select

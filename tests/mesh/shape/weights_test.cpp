#include "mesh/shape/weights.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "base/deterministic_math.h"
#include "mesh/shape/free_edge.h"
#include "mesh/shape/move.h"
#include "tests/mesh/shape/weighed.h"
#include "tests/support/make_model.h"

namespace prismesh::mesh::shape {
namespace {

using test::grid_node;
using test::make_grid;
using test::make_model;
using test::nodes_where;
using test::Weighed;

Model flat_grid(int columns, int rows) {
  return make_grid(columns, rows, [](int i, int j) { return Vec3(i, j, 0); });
}

WeightOptions linear() {
  WeightOptions options;
  options.falloff.profile = Profile::linear;
  return options;
}

TEST(FreeEdges, have_corners_below_135_and_beyond_250_degrees) {
  // four triangles about a node, which together surround it by so many degrees
  const auto is_corner = [](double degrees) {
    std::vector<Vec3> points{Vec3(0, 0, 0)};
    for (int i = 0; i <= 4; ++i)
      points.emplace_back(deterministic_cos_degrees(degrees * i / 4), deterministic_sin_degrees(degrees * i / 4), 0);
    return is_boundary_corner(test::make_shells(points, {{0, 1, 2, 2}, {0, 2, 3, 3}, {0, 3, 4, 4}, {0, 4, 5, 5}}), NodeIndex(0));
  };
  EXPECT_TRUE(is_corner(90));
  EXPECT_TRUE(is_corner(134));
  EXPECT_FALSE(is_corner(136));
  EXPECT_FALSE(is_corner(180));
  EXPECT_FALSE(is_corner(249)) << "a node of a hole of six";
  EXPECT_TRUE(is_corner(251));
  EXPECT_TRUE(is_corner(270));
}

TEST(Weights, grab_a_node_of_a_shell_where_nothing_is_border) {
  const Model model = make_model({{1, {9, 9, 9}}, {2, {0, 0, 0}}, {3, {1, 0, 0}}, {4, {1, 1, 0}}}, {{1, 1, {2, 3, 4}}});
  const Weighed w(model, {NodeIndex(0), NodeIndex(1), NodeIndex(2), NodeIndex(3)}, std::nullopt, linear());
  EXPECT_EQ(w.weights.grab, NodeIndex(1));
}

TEST(Weights, are_one_at_the_grab_and_zero_on_the_rim) {
  const Model model = flat_grid(20, 20);
  const NodeSet selection = nodes_where(model, [](const Vec3& p) { return p.x() >= 4 && p.x() <= 16 && p.y() >= 4 && p.y() <= 16; });
  const Weighed w(model, selection, grid_node(20, 10, 10), linear());
  EXPECT_EQ(w(grid_node(20, 10, 10)), 1);
  for (int k = 4; k <= 16; ++k) {
    EXPECT_EQ(w(grid_node(20, k, 4)), 0);
    EXPECT_EQ(w(grid_node(20, k, 16)), 0);
    EXPECT_EQ(w(grid_node(20, 4, k)), 0);
    EXPECT_EQ(w(grid_node(20, 16, k)), 0);
  }
  // straight down from the grab: d_origin + d_border is always 6
  for (int k = 4; k <= 10; ++k) EXPECT_NEAR(w(grid_node(20, 10, k)), (k - 4) / 6.0, 1e-12);
  // (13, 10): 3 from the grab, 3 from the rim; (13, 13): 3√2 and 3
  EXPECT_NEAR(w(grid_node(20, 13, 10)), 0.5, 1e-12);
  EXPECT_NEAR(w(grid_node(20, 13, 13)), 1 / (1 + std::sqrt(2.0)), 1e-12);
  EXPECT_EQ(w.weights.unreached, 0u);
}

TEST(Weights, take_the_node_farthest_from_the_border_without_a_grab) {
  const Model model = flat_grid(20, 20);
  const NodeSet selection = nodes_where(model, [](const Vec3& p) { return p.x() >= 4 && p.x() <= 16 && p.y() >= 2 && p.y() <= 14; });
  EXPECT_EQ(Weighed(model, selection, std::nullopt, linear()).weights.grab, grid_node(20, 10, 8));
  const NodeSet everything = nodes_where(model, [](const Vec3&) { return true; });
  EXPECT_EQ(Weighed(model, everything, std::nullopt, linear()).weights.grab, NodeIndex(0));
}

TEST(Weights, stretch_a_strip_by_its_free_border_with_rows_evenly_spaced) {
  const Model model = flat_grid(8, 20);
  const NodeSet selection = nodes_where(model, [](const Vec3& p) { return p.y() >= 5; });
  for (const std::optional<NodeIndex> grab :
       {std::optional(grid_node(8, 4, 20)), std::optional(grid_node(8, 0, 20)), std::optional<NodeIndex>()}) {
    const Weighed w(model, selection, grab, linear());
    std::vector<Vec3> start;
    for (const NodeIndex node : selection) start.push_back(model.position(node));
    std::vector<Vec3> moved(start.size());
    translate(start, w.weights.weight, Vec3(0, 7.5, 0), moved);
    for (std::size_t k = 0; k < selection.size(); ++k) {
      const double row = start[k].y() - 5;
      EXPECT_NEAR(moved[k].y(), 5 + row * (15 + 7.5) / 15, 1e-9) << "row " << row;
    }
  }
}

TEST(Weights, stretch_a_bent_section_by_its_free_border) {
  // a hat section: the free edge turns in space but runs straight along the surface
  const auto place = [](int i, int j) {
    const double profile_y = i < 4 ? i : i < 8 ? 4 : i - 4.0;
    const double profile_z = i < 4 ? 0 : i < 8 ? i - 4.0 : 4;
    return Vec3(j, profile_y, profile_z);
  };
  const Model model = make_grid(12, 20, place);
  const NodeSet selection = nodes_where(model, [](const Vec3& p) { return p.x() >= 10; });
  const Weighed w(model, selection, grid_node(12, 6, 20), linear());
  for (std::size_t k = 0; k < selection.size(); ++k) EXPECT_NEAR(w.weights.weight[k], (model.position(selection[k]).x() - 10) / 10, 1e-9);
}

TEST(Weights, fall_off_to_the_own_boundary_without_free_ends) {
  const Model model = flat_grid(8, 20);
  const NodeSet selection = nodes_where(model, [](const Vec3& p) { return p.y() >= 5; });
  WeightOptions options = linear();
  options.free_ends = FreeEnds::held;
  const Weighed w(model, selection, grid_node(8, 4, 12), options);
  for (int i = 0; i <= 8; ++i) EXPECT_EQ(w(grid_node(8, i, 20)), 0);
  for (int j = 5; j <= 20; ++j) EXPECT_EQ(w(grid_node(8, 0, j)), 0);
  EXPECT_NEAR(w(grid_node(8, 2, 12)), 0.5, 1e-12);
  // grabbed on that boundary: 1 there alone
  const Weighed held(model, selection, grid_node(8, 4, 20), options);
  EXPECT_EQ(held(grid_node(8, 4, 20)), 1);
  EXPECT_EQ(held(grid_node(8, 3, 20)), 0);
  // with the whole free edge asked for: 1 along it
  options.origin = Origin::free_edge;
  const Weighed edge(model, selection, grid_node(8, 4, 20), options);
  EXPECT_EQ(edge(grid_node(8, 2, 20)), 1);
  EXPECT_EQ(edge(grid_node(8, 0, 10)), 0);
}

TEST(Weights, keep_the_pure_formula_for_weighted_free_ends) {
  const Model model = flat_grid(8, 20);
  const NodeSet selection = nodes_where(model, [](const Vec3& p) { return p.y() >= 5; });
  WeightOptions options = linear();
  options.free_ends = FreeEnds::weighted;
  const Weighed w(model, selection, grid_node(8, 4, 15), options);
  EXPECT_NEAR(w(grid_node(8, 4, 20)), 15.0 / 20, 1e-12);
  EXPECT_NEAR(w(grid_node(8, 4, 10)), 0.5, 1e-12);
}

TEST(Weights, take_the_nearest_free_edge_when_asked_for_it) {
  const Model model = flat_grid(8, 20);
  const NodeSet selection = nodes_where(model, [](const Vec3& p) { return p.y() >= 5; });
  WeightOptions options = linear();
  options.origin = Origin::free_edge;
  const Weighed w(model, selection, grid_node(8, 4, 18), options);
  for (int j = 5; j <= 20; ++j) EXPECT_NEAR(w(grid_node(8, 3, j)), (j - 5) / 15.0, 1e-9);
  const NodeSet inside = nodes_where(model, [](const Vec3& p) { return p.y() >= 5 && p.y() <= 15 && p.x() >= 2 && p.x() <= 6; });
  const auto refused = compute_weights(model, inside, std::nullopt, options);
  ASSERT_FALSE(refused.has_value());
  EXPECT_NE(refused.error().message.find("free edge"), std::string::npos);
}

TEST(Weights, are_one_at_a_grab_on_the_border_and_zero_on_the_rest_of_it) {
  const Model model = flat_grid(20, 20);
  const NodeSet selection = nodes_where(model, [](const Vec3& p) { return p.x() >= 4 && p.x() <= 16 && p.y() >= 4 && p.y() <= 16; });
  const Weighed w(model, selection, grid_node(20, 10, 4), linear());
  EXPECT_EQ(w(grid_node(20, 10, 4)), 1);
  EXPECT_EQ(w(grid_node(20, 9, 4)), 0);
  EXPECT_EQ(w(grid_node(20, 4, 10)), 0);
  EXPECT_GT(w(grid_node(20, 10, 5)), 0);
  for (const double weight : w.weights.weight) EXPECT_TRUE(weight >= 0 && weight <= 1);
}

TEST(Weights, move_a_single_node_and_a_row_on_a_free_edge) {
  const Model model = flat_grid(6, 6);
  const Weighed single(model, {grid_node(6, 3, 3)}, std::nullopt, WeightOptions());
  EXPECT_EQ(single.weights.weight, std::vector<double>{1});
  const NodeSet row = nodes_where(model, [](const Vec3& p) { return p.y() == 6; });
  const Weighed moved(model, row, grid_node(6, 3, 6), WeightOptions());
  for (const double weight : moved.weights.weight) EXPECT_EQ(weight, 1);
}

TEST(Weights, are_one_where_there_is_no_border) {
  const Model model = flat_grid(6, 6);
  const NodeSet everything = nodes_where(model, [](const Vec3&) { return true; });
  const Weighed w(model, everything, grid_node(6, 3, 3), WeightOptions());
  for (const double weight : w.weights.weight) EXPECT_EQ(weight, 1);
  EXPECT_EQ(w.weights.unreached, 0u);
}

TEST(Weights, leave_unreached_pieces_and_lone_nodes_behind_and_count_them) {
  // two sheets side by side and a lone beam
  const Model model = make_model({{1, {0, 0, 0}},
                                  {2, {1, 0, 0}},
                                  {3, {1, 1, 0}},
                                  {4, {0, 1, 0}},
                                  {5, {5, 0, 0}},
                                  {6, {6, 0, 0}},
                                  {7, {6, 1, 0}},
                                  {8, {5, 1, 0}},
                                  {9, {9, 0, 0}},
                                  {10, {9, 1, 0}}},
                                 {{1, 1, {1, 2, 3, 4}}, {2, 2, {5, 6, 7, 8}}}, {{ElementClass::beam, 1, 3, {9, 10}}});
  const NodeSet everything = nodes_where(model, [](const Vec3&) { return true; });
  const Weighed w(model, everything, NodeIndex(1), WeightOptions());
  EXPECT_EQ(w.weights.weight, (std::vector<double>{1, 1, 1, 1, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(w.weights.unreached, 6u);
  WeightOptions constant;
  constant.falloff.profile = Profile::constant;
  const Weighed rigid(model, everything, NodeIndex(1), constant);
  EXPECT_EQ(rigid.weights.weight, std::vector<double>(10, 1.0));
  EXPECT_EQ(rigid.weights.unreached, 6u);
  const Weighed lone(model, {NodeIndex(8)}, std::nullopt, WeightOptions());
  EXPECT_EQ(lone.weights.weight, std::vector<double>{1});
}

TEST(Weights, move_the_whole_selection_with_the_constant_profile) {
  const Model model = flat_grid(10, 10);
  const NodeSet selection = nodes_where(model, [](const Vec3& p) { return p.x() <= 5; });
  WeightOptions options;
  options.falloff.profile = Profile::constant;
  const Weighed w(model, selection, std::nullopt, options);
  EXPECT_EQ(w.weights.weight, std::vector<double>(selection.size(), 1.0));
}

TEST(Weights, along_a_direction_are_constant_across_it) {
  const Model model = flat_grid(20, 20);
  const NodeSet selection = nodes_where(model, [](const Vec3& p) { return p.x() >= 4 && p.x() <= 16 && p.y() >= 4 && p.y() <= 16; });
  WeightOptions options = linear();
  options.falloff.along = Vec3(0, 2, 0);
  const Weighed w(model, selection, grid_node(20, 7, 10), options);
  for (int i = 4; i <= 16; ++i)
    for (int j = 4; j <= 16; ++j) EXPECT_NEAR(w(grid_node(20, i, j)), 1 - std::abs(j - 10) / 6.0, 1e-12);
}

TEST(Weights, along_a_direction_do_not_fall_off_towards_a_free_end) {
  const Model model = flat_grid(20, 20);
  // the patch reaches the free upper edge; its sides have neighbours
  const NodeSet selection = nodes_where(model, [](const Vec3& p) { return p.x() >= 4 && p.x() <= 16 && p.y() >= 4; });
  WeightOptions options = linear();
  options.falloff.along = Vec3(0, 1, 0);
  const Weighed w(model, selection, grid_node(20, 10, 10), options);
  for (int j = 10; j <= 20; ++j) EXPECT_EQ(w(grid_node(20, 6, j)), 1);
  EXPECT_NEAR(w(grid_node(20, 6, 7)), 0.5, 1e-12);
  options.free_ends = FreeEnds::held;
  const Weighed held(model, selection, grid_node(20, 10, 10), options);
  EXPECT_NEAR(held(grid_node(20, 6, 15)), 0.5, 1e-12);
}

/// A plate of unit squares, bent over a square grid so that its inner boundary is a circle of `around` nodes.
Model plate_with_round_hole(int around, int rings, double hole_radius) {
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  for (int r = 0; r <= rings; ++r)
    for (int a = 0; a < around; ++a) {
      const double angle = 2 * std::numbers::pi * a / around;
      const double radius = hole_radius * std::pow(1 + 2 * std::numbers::pi / around, r);
      nodes.push_back({1 + a + r * around, Vec3(radius * std::cos(angle), radius * std::sin(angle), 0)});
    }
  for (int r = 0; r < rings; ++r)
    for (int a = 0; a < around; ++a) {
      const int b = (a + 1) % around;
      shells.push_back(
          {1 + a + r * around, 1, {1 + a + r * around, 1 + b + r * around, 1 + b + (r + 1) * around, 1 + a + (r + 1) * around}});
    }
  return make_model(nodes, shells);
}

TEST(Weights, move_a_round_hole_as_a_whole) {
  for (const int around : {6, 8, 16, 64}) {
    const Model model = plate_with_round_hole(around, 12, 10);
    const double rim = model.positions[static_cast<std::size_t>(10 * around)].norm();
    const NodeSet selection = nodes_where(model, [&](const Vec3& p) { return p.norm() <= rim * (1 + 1e-9); });
    const Weighed w(model, selection, NodeIndex(2), WeightOptions());
    std::vector<Vec3> start;
    for (const NodeIndex node : selection) start.push_back(model.position(node));
    std::vector<Vec3> moved(start.size());
    translate(start, w.weights.weight, Vec3(3, 1, 2), moved);
    for (int a = 0; a < around; ++a) EXPECT_NEAR((moved[static_cast<std::size_t>(a)] - Vec3(3, 1, 2)).norm(), 10, 1e-12);
    // and rings around it stay round too: the weight is a function of the radius alone
    for (int r = 1; r < 10; ++r)
      for (int a = 1; a < around; ++a)
        EXPECT_NEAR(w.weights.weight[static_cast<std::size_t>(r * around + a)], w.weights.weight[static_cast<std::size_t>(r * around)],
                    1e-9);
  }
}

TEST(Weights, make_a_round_dent) {
  // weights around a grab inside a disc: equal on a circle around it, although the mesh is square
  const Model model = flat_grid(80, 80);
  const Vec3 centre(40, 40, 0);
  const NodeSet selection = nodes_where(model, [&](const Vec3& p) { return (p - centre).norm() <= 36; });
  const Weighed w(model, selection, grid_node(80, 40, 40), linear());
  double deviation = 0;
  for (std::size_t k = 0; k < selection.size(); ++k) {
    const double r = (model.position(selection[k]) - centre).norm();
    if (r <= 25) deviation = std::max(deviation, std::abs(w.weights.weight[k] - (1 - r / 36)));
  }
  // what is left is the rim's own raggedness: a rim of squares is up to √2 nearer than the circle
  EXPECT_LE(deviation, 1.5 / 36);
}

TEST(Weights, do_not_change_under_rigid_motion) {
  const Eigen::AngleAxisd turn(0.7, Vec3(1, 2, 3).normalized());
  const auto place = [](int i, int j) { return Vec3(i + 0.2 * std::sin(3 * i + j), j + 0.2 * std::cos(2 * i - j), 2 * std::sin(i / 5.0)); };
  const Model model = make_grid(20, 20, place);
  const Model turned = make_grid(20, 20, [&](int i, int j) { return Vec3(turn * place(i, j) + Vec3(100, -50, 3)); });
  NodeSet selection;
  for (int j = 3; j <= 18; ++j)
    for (int i = 2; i <= 17; ++i) selection.push_back(grid_node(20, i, j));
  const Weighed a(model, selection, grid_node(20, 9, 8), WeightOptions());
  const Weighed b(turned, selection, grid_node(20, 9, 8), WeightOptions());
  for (std::size_t k = 0; k < selection.size(); ++k) EXPECT_NEAR(a.weights.weight[k], b.weights.weight[k], 1e-9);
}

TEST(Weights, refuse_what_they_cannot_do) {
  const Model model = flat_grid(4, 4);
  const auto message = [&](const NodeSet& selection, std::optional<NodeIndex> grab, const WeightOptions& options) {
    const auto result = compute_weights(model, selection, grab, options);
    return result ? std::string("done") : result.error().message;
  };
  EXPECT_EQ(message({}, std::nullopt, {}), "nothing is selected");
  EXPECT_EQ(message({NodeIndex(1)}, NodeIndex(2), {}), "the grabbed node:3 isn't selected");
  WeightOptions options;
  options.falloff.along = Vec3::Zero();
  EXPECT_NE(message({NodeIndex(1)}, std::nullopt, options).find("along"), std::string::npos);
  options = {};
  options.falloff.flat = 1.5;
  EXPECT_NE(message({NodeIndex(1)}, std::nullopt, options).find("between 0 and 1"), std::string::npos);
}

}  // namespace
}  // namespace prismesh::mesh::shape

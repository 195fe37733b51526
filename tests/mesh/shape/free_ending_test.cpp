// Free endings: what lies between the grab or the axis and a free edge moves by the whole displacement.
#include "mesh/shape/free_ending.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/deterministic_math.h"
#include "mesh/shape/move.h"
#include "mesh/shape/rotate.h"
#include "tests/mesh/shape/weighed.h"
#include "tests/support/make_model.h"

namespace prismesh::mesh::shape {
namespace {

using std::numbers::pi;
using test::grid_node;
using test::make_grid;
using test::nodes_where;
using test::Weighed;

constexpr int kColumns = 20, kRows = 10;

/// A strip 200 long and 100 wide, of elements of 10.
Model strip() {
  return make_grid(kColumns, kRows, [](int i, int j) { return Vec3(10 * i, 10 * j, 0); });
}

NodeIndex strip_node(int x, int y) { return grid_node(kColumns, x / 10, y / 10); }

NodeSet from_50(const Model& model) {
  return nodes_where(model, [](const Vec3& p) { return p.x() >= 50; });
}

WeightOptions with(Profile profile, FreeEnds ends = FreeEnds::rigid) {
  WeightOptions options;
  options.falloff.profile = profile;
  options.free_ends = ends;
  return options;
}

/// The weights of a selection as a turn about an axis gives them.
Weights turn_weights(const Model& model, const NodeSet& selection, NodeIndex grab, const WeightOptions& options, const Axis& axis) {
  const Result<Weights> weights = compute_weights(model, selection, grab, options, {axis, {}});
  EXPECT_TRUE(weights.has_value());
  return *weights;
}

std::vector<Vec3> turned(const Model& model, const Weights& weights, const Axis& axis, double degrees) {
  std::vector<Vec3> start, out;
  for (const NodeIndex node : weights.nodes) start.push_back(model.position(node));
  out.resize(start.size());
  rotate(start, weights.weight, {axis, degrees, {}}, out);
  return out;
}

const Axis kMiddle{Vec3(120, 0, 0), Vec3(0, 1, 0)};

TEST(FreeEndings, of_a_strip_follow_a_lift_from_the_grab_outwards) {
  const Model model = strip();
  for (const int y : {0, 30, 50, 100})
    for (const Profile profile : {Profile::linear, Profile::smooth, Profile::gaussian}) {
      const Weighed w(model, from_50(model), strip_node(120, y), with(profile));
      Falloff falloff;
      falloff.profile = profile;
      for (const NodeIndex node : w.weights.nodes) {
        const double x = model.position(node).x();
        EXPECT_NEAR(w(node), x >= 120 ? 1 : evaluate(falloff, (x - 50) / 70), 1e-12) << x << ", grab at y = " << y;
      }
      EXPECT_GE(w.weights.free_ending, 90u);
    }
}

TEST(FreeEndings, fall_off_and_cup_with_weighted_free_ends) {
  const Model model = strip();
  const Weighed w(model, from_50(model), strip_node(120, 50), with(Profile::smooth, FreeEnds::weighted));
  EXPECT_NEAR(10 * w(strip_node(200, 50)), 7.5, 0.5);
  EXPECT_LT(10 * w(strip_node(200, 0)), 10 * w(strip_node(200, 50)) - 0.5);
  EXPECT_EQ(w.weights.free_ending, 0u);
}

TEST(FreeEndings, turn_rigidly_beyond_the_axis_wherever_the_grab_is) {
  const Model model = strip();
  const double sin30 = 0.5, cos30 = std::sqrt(3) / 2;
  for (const NodeIndex grab : {strip_node(120, 50), strip_node(120, 0), strip_node(160, 30), strip_node(200, 50), strip_node(200, 0)}) {
    const Weights weights = turn_weights(model, from_50(model), grab, with(Profile::linear), kMiddle);
    const std::vector<Vec3> out = turned(model, weights, kMiddle, -30);
    for (std::size_t i = 0; i < out.size(); ++i) {
      const Vec3& p = model.position(weights.nodes[i]);
      if (p.x() >= 120) {
        EXPECT_NEAR((out[i] - Vec3(120 + (p.x() - 120) * cos30, p.y(), (p.x() - 120) * sin30)).norm(), 0, 1e-9) << p.transpose();
      } else {
        EXPECT_NEAR(weights.weight[i], (p.x() - 50) / 70, 1e-9) << p.transpose();
      }
    }
  }
}

TEST(FreeEndings, begin_at_a_grab_before_the_axis) {
  const Model model = strip();
  const Weights weights = turn_weights(model, from_50(model), strip_node(90, 50), with(Profile::linear), kMiddle);
  for (std::size_t i = 0; i < weights.nodes.size(); ++i) {
    const double x = model.position(weights.nodes[i]).x();
    EXPECT_NEAR(weights.weight[i], std::min(1.0, (x - 50) / 40), 1e-9) << x;
  }
  // an axis outside the selection cuts nothing: the same
  const Axis outside{Vec3(20, 0, 0), Vec3(0, 1, 0)};
  EXPECT_EQ(turn_weights(model, from_50(model), strip_node(90, 50), with(Profile::linear), outside).weight, weights.weight);
}

TEST(FreeEndings, turn_about_a_hinge_at_the_rim) {
  const Model model = strip();
  const Axis hinge{Vec3(50, 0, 0.01), Vec3(0, 1, 0)};
  const Weights weights = turn_weights(model, from_50(model), strip_node(200, 50), with(Profile::smooth), hinge);
  for (std::size_t i = 0; i < weights.nodes.size(); ++i) EXPECT_EQ(weights.weight[i], model.position(weights.nodes[i]).x() > 50 ? 1 : 0);
}

TEST(FreeEndings, turn_about_an_axis_aslant_and_one_across_the_sheet) {
  const Model model = strip();
  const Axis aslant{Vec3(130, 50, 0), Vec3(1, 2, 0).normalized()};
  const Weights slanted = turn_weights(model, from_50(model), strip_node(130, 50), with(Profile::linear), aslant);
  const Axis across{Vec3(125, 50, 0), Vec3(0, 0, 1)};
  const Weights pivoted = turn_weights(model, from_50(model), strip_node(200, 50), with(Profile::linear), across);
  for (std::size_t i = 0; i < slanted.nodes.size(); ++i) {
    const Vec3& p = model.position(slanted.nodes[i]);
    const double beyond = Vec3(2, -1, 0).normalized().dot(p - aslant.point);
    const double before = std::max(0.0, -beyond);
    EXPECT_NEAR(slanted.weight[i], before < 1e-9 ? 1 : (p.x() - 50) / (p.x() - 50 + before), 0.03) << p.transpose();
    EXPECT_NEAR(pivoted.weight[i], std::min(1.0, (p.x() - 50) / 75), 1e-9) << p.transpose();
  }
}

/// The strip with its inner nodes moved by chance, so that neither grab nor axis is on a row.
Model jittered_strip() {
  return make_grid(2 * kColumns, 2 * kRows, [](int i, int j) {
    const bool inside = i > 10 && i < 40 && j > 0 && j < 20;
    return Vec3(5 * i + (inside ? 1.5 * std::sin(7.0 * i + 3 * j) : 0), 5 * j + (inside ? 1.5 * std::cos(5.0 * j - 4 * i) : 0), 0);
  });
}

TEST(FreeEndings, have_a_straight_edge_on_an_irregular_mesh) {
  const Model model = jittered_strip();
  const NodeIndex grab = grid_node(2 * kColumns, 25, 11);
  const double at = model.position(grab).x();
  const Weighed w(model, from_50(model), grab, with(Profile::linear));
  const Axis axis{Vec3(at, 0, 0), Vec3(0, 1, 0)};
  const Weights weights = turn_weights(model, from_50(model), grab, with(Profile::linear), axis);
  for (std::size_t i = 0; i < weights.nodes.size(); ++i) {
    const double expected = std::min(1.0, (model.position(weights.nodes[i]).x() - 50) / (at - 50));
    // the distances themselves are that exact
    EXPECT_NEAR(w.weights.weight[i], expected, 2e-2) << model.position(weights.nodes[i]).transpose();
    EXPECT_NEAR(weights.weight[i], expected, 2e-2) << model.position(weights.nodes[i]).transpose();
  }
}

/// A tube of 48 quads around and 30 along.
Model tube() {
  constexpr int kAround = 48, kAlong = 30;
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  for (int i = 0; i <= kAlong; ++i)
    for (int k = 0; k < kAround; ++k)
      nodes.push_back({1 + k + kAround * i, Vec3(5 * i, 40 * std::cos(2 * pi * k / kAround), 40 * std::sin(2 * pi * k / kAround))});
  for (int i = 0; i < kAlong; ++i)
    for (int k = 0; k < kAround; ++k) {
      const int a = 1 + k + kAround * i, b = 1 + (k + 1) % kAround + kAround * i;
      shells.push_back({a, 1, {a, b, b + kAround, a + kAround}});
    }
  return test::make_model(nodes, shells);
}

TEST(FreeEndings, of_a_closed_section_follow_too) {
  const Model model = tube();
  const NodeSet selection = nodes_where(model, [](const Vec3& p) { return p.x() >= 40; });
  const NodeIndex grab = model.find_node(1 + 11 + 48 * 18);
  const Weighed w(model, selection, grab, with(Profile::linear));
  const Axis axis{Vec3(90, 0, 0), Vec3(0, 1, 0)};
  const Weights weights = turn_weights(model, selection, grab, with(Profile::linear), axis);
  for (std::size_t i = 0; i < selection.size(); ++i) {
    const double x = model.position(selection[i]).x();
    EXPECT_NEAR(w.weights.weight[i], std::min(1.0, (x - 40) / 50), 1e-9) << x;
    EXPECT_NEAR(weights.weight[i], std::min(1.0, (x - 40) / 50), 1e-9) << x;
  }
}

/// A strip folded twice in the shape of an S: three legs of 100, 20 apart. `along` runs over its length of 340.
Model folded() {
  const auto place = [](int i, int j) {
    const double along = 10 * i;
    const double y = 10 * j;
    if (along <= 100) return Vec3(along, y, 0);
    if (along <= 120) return Vec3(100, y, along - 100);
    if (along <= 220) return Vec3(220 - along, y, 20);
    if (along <= 240) return Vec3(0, y, along - 200);
    return Vec3(along - 240, y, 40);
  };
  return make_grid(34, 6, place);
}

TEST(FreeEndings, begin_where_the_axis_is_nearest_on_a_folded_sheet) {
  const Model model = folded();
  NodeSet selection;
  for (std::uint32_t n = 0; n < model.node_count(); ++n)
    if (n % 35 >= 2) selection.push_back(NodeIndex(n));
  for (const int at : {290, 170, 60}) {  // on the upper, the middle, the lower leg: the plane cuts all three
    const Vec3 point = model.position(grid_node(34, at / 10, 0));
    const Axis axis{point, Vec3(0, 1, 0)};
    const Weights weights = turn_weights(model, selection, grid_node(34, at / 10, 3), with(Profile::linear), axis);
    for (std::size_t i = 0; i < selection.size(); ++i) {
      const double along = 10.0 * (selection[i].value % 35);
      EXPECT_NEAR(weights.weight[i], std::min(1.0, (along - 20) / (at - 20)), 1e-9) << along << " of " << at;
    }
  }
}

TEST(FreeEndings, end_where_the_outer_row_is_deselected) {
  const Model model = strip();
  const NodeSet selection = nodes_where(model, [](const Vec3& p) { return p.x() >= 50 && p.x() < 200; });
  const Weighed rigid(model, selection, strip_node(120, 50), with(Profile::smooth));
  const Weighed weighted(model, selection, strip_node(120, 50), with(Profile::smooth, FreeEnds::weighted));
  EXPECT_EQ(rigid.weights.weight, weighted.weights.weight);
  EXPECT_EQ(turn_weights(model, selection, strip_node(120, 50), with(Profile::smooth), kMiddle).weight, weighted.weights.weight);
}

/// The strip with a hole of 2 x 2 elements about a place.
Model strip_with_hole(int x, int y) {
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  for (int j = 0; j <= kRows; ++j)
    for (int i = 0; i <= kColumns; ++i) nodes.push_back({1 + i + (kColumns + 1) * j, Vec3(10 * i, 10 * j, 0)});
  for (int j = 0; j < kRows; ++j)
    for (int i = 0; i < kColumns; ++i) {
      if (std::abs(10 * i + 5 - x) < 10 && std::abs(10 * j + 5 - y) < 10) continue;
      const int a = 1 + i + (kColumns + 1) * j;
      shells.push_back({a, 1, {a, a + 1, a + 2 + kColumns, a + 1 + kColumns}});
    }
  return test::make_model(nodes, shells);
}

TEST(FreeEndings, are_not_made_by_a_hole_inside_a_held_patch) {
  const Model model = strip_with_hole(100, 50);
  const NodeSet selection =
      nodes_where(model, [](const Vec3& p) { return p.x() >= 20 && p.x() <= 180 && p.y() >= 10 && p.y() <= 90 && p != Vec3(100, 50, 0); });
  for (const NodeIndex grab : {strip_node(70, 50), strip_node(90, 50), strip_node(50, 40)}) {
    const Weighed rigid(model, selection, grab, with(Profile::smooth));
    const Weighed weighted(model, selection, grab, with(Profile::smooth, FreeEnds::weighted));
    EXPECT_EQ(rigid.weights.weight, weighted.weights.weight);
    EXPECT_EQ(rigid.weights.free_ending, 0u);
  }
}

TEST(FreeEndings, follow_a_hole_that_is_grabbed_before_them) {
  const Model model = strip_with_hole(100, 50);
  const NodeSet selection = nodes_where(model, [](const Vec3& p) { return p.x() >= 50 && p != Vec3(100, 50, 0); });
  for (const NodeIndex grab : {strip_node(90, 50), strip_node(110, 60)}) {
    const Weighed w(model, selection, grab, with(Profile::linear));
    for (const NodeIndex node : selection) {
      const double x = model.position(node).x();
      EXPECT_NEAR(w(node), std::min(1.0, (x - 50) / 40), 1e-9) << x;
    }
  }
}

TEST(FreeEndings, need_a_free_edge_that_is_long_enough) {
  // a round patch whose far side just reaches the free edge of the sheet: the grab stays the one summit
  const Model model = make_grid(60, 60, [](int i, int j) { return Vec3(i, j, 0); });
  const NodeSet round = nodes_where(model, [](const Vec3& p) { return (p - Vec3(30, 38, 0)).norm() <= 28; });
  const Weighed rigid(model, round, grid_node(60, 30, 22), with(Profile::smooth));
  const Weighed weighted(model, round, grid_node(60, 30, 22), with(Profile::smooth, FreeEnds::weighted));
  EXPECT_EQ(rigid.weights.weight, weighted.weights.weight);
  // half a disc at the free edge: what lies between the grab and the edge moves as one
  const NodeSet half = nodes_where(model, [](const Vec3& p) { return (p - Vec3(30, 60, 0)).norm() <= 28; });
  const Weighed w(model, half, grid_node(60, 30, 46), with(Profile::smooth));
  for (int j = 46; j <= 60; ++j) EXPECT_EQ(w(grid_node(60, 30, j)), 1);
  EXPECT_EQ(w(grid_node(60, 25, 60)), 1);
  EXPECT_LT(w(grid_node(60, 50, 60)), 0.7);
}

TEST(FreeEndings, are_only_those_behind_the_grab) {
  // two tongues on one root: the one that isn't grabbed keeps its weights by distance
  const Model model = test::make_model(
      [] {
        std::vector<test::NodeSpec> nodes;
        for (int j = 0; j <= 11; ++j)
          for (int i = 0; i <= 20; ++i) nodes.push_back({1 + i + 21 * j, Vec3(10 * i, 10 * j, 0)});
        return nodes;
      }(),
      [] {
        std::vector<test::ShellSpec> shells;
        for (int j = 0; j < 11; ++j)
          for (int i = 0; i < 20; ++i)
            if (i < 10 || j != 5) shells.push_back({1 + i + 21 * j, 1, {1 + i + 21 * j, 2 + i + 21 * j, 23 + i + 21 * j, 22 + i + 21 * j}});
        return shells;
      }());
  const NodeSet selection = from_50(model);
  const auto node = [&](int x, int y) { return model.find_node(1 + x / 10 + 21 * (y / 10)); };
  const Weighed w(model, selection, node(150, 20), with(Profile::linear));
  for (int y = 0; y <= 50; y += 10) EXPECT_EQ(w(node(200, y)), 1) << y;
  for (int y = 60; y <= 110; y += 10) EXPECT_LT(w(node(200, y)), 0.9) << y;
  // an axis across both turns both
  const Weights weights = turn_weights(model, selection, node(150, 20), with(Profile::linear), {Vec3(150, 0, 0), Vec3(0, 1, 0)});
  for (std::size_t i = 0; i < selection.size(); ++i) EXPECT_TRUE(model.position(selection[i]).x() < 150 || weights.weight[i] == 1);
}

TEST(FreeEndings, of_a_side_begin_at_its_grab) {
  // the end is slanted: the side at y = 0 is the longer one, its outer corner the farthest node
  const Model model = make_grid(kColumns, kRows, [](int i, int j) { return Vec3(10 * i * (1 - 0.03 * j), 10 * j, 0); });
  const NodeSet selection = nodes_where(model, [](const Vec3& p) { return p.x() >= 49; });
  const Weighed w(model, selection, strip_node(190, 0), with(Profile::linear));
  EXPECT_EQ(w(strip_node(190, 0)), 1);
  EXPECT_EQ(w(strip_node(200, 0)), 1);
  EXPECT_LT(w(strip_node(120, 0)), 0.6) << "the side isn't the origin";
  EXPECT_GT(w(strip_node(180, 0)), 0.9);
  for (const double weight : w.weights.weight) EXPECT_TRUE(weight >= 0 && weight <= 1);
}

TEST(FreeEndings, leave_a_strip_that_is_held_at_both_ends) {
  const Model model = strip();
  const NodeSet selection = nodes_where(model, [](const Vec3& p) { return p.x() >= 20 && p.x() <= 180; });
  const Weighed rigid(model, selection, strip_node(70, 50), with(Profile::smooth));
  const Weighed weighted(model, selection, strip_node(70, 50), with(Profile::smooth, FreeEnds::weighted));
  EXPECT_EQ(rigid.weights.weight, weighted.weights.weight);
}

TEST(FreeEndings, turn_as_one_with_a_falloff_in_one_direction) {
  const Model model = strip();
  WeightOptions options = with(Profile::linear);
  options.falloff.along = Vec3(1, 0, 0);
  for (const NodeIndex grab : {strip_node(120, 50), strip_node(200, 50), strip_node(120, 0)}) {
    const Weights weights = turn_weights(model, from_50(model), grab, options, kMiddle);
    for (std::size_t i = 0; i < weights.nodes.size(); ++i)
      EXPECT_NEAR(weights.weight[i], std::min(1.0, (model.position(weights.nodes[i]).x() - 50) / 70), 1e-12);
  }
}

TEST(FreeEndings, carry_across_welds) {
  // a second sheet half an element above the strip's outer half
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  for (int sheet = 0; sheet < 2; ++sheet)
    for (int j = 0; j <= kRows; ++j)
      for (int i = sheet == 0 ? 0 : 13; i <= kColumns; ++i) {
        const int a = 1 + i + (kColumns + 1) * j + 1000 * sheet;
        nodes.push_back({a, Vec3(10 * i, 10 * j, 5 * sheet)});
        if (i < kColumns && j < kRows) shells.push_back({a, 1 + sheet, {a, a + 1, a + 2 + kColumns, a + 1 + kColumns}});
      }
  const Model model = test::with_thickness(test::make_model(nodes, shells), 5);
  WeightOptions options = with(Profile::smooth);
  options.across_welds = true;
  const Weighed w(model, from_50(model), model.find_node(1 + 12 + 21 * 5), options);
  for (const NodeIndex node : w.weights.nodes) EXPECT_TRUE(model.position(node).x() < 130 || std::abs(w(node) - 1) < 1e-12);
  EXPECT_EQ(w.weights.unreached, 0u);
}

TEST(FreeEdgeAsOrigin, is_the_one_beyond_the_grab) {
  const Model model = strip();
  WeightOptions options = with(Profile::linear);
  options.origin = Origin::free_edge;
  for (const NodeIndex grab : {strip_node(120, 50), strip_node(120, 90), strip_node(70, 10)}) {
    const Weighed w(model, from_50(model), grab, options);
    for (const NodeIndex node : w.weights.nodes) EXPECT_NEAR(w(node), (model.position(node).x() - 50) / 150, 1e-9);
    ASSERT_TRUE(w.weights.edge.valid() && w.weights.other_edge.valid());
    EXPECT_EQ(model.position(w.weights.edge).x(), 200);
    EXPECT_LT(model.position(w.weights.other_edge).x(), 200) << "the side that is nearest";
  }
  // the nearest one, with weighted ends, as ever
  options.free_ends = FreeEnds::weighted;
  const Weighed nearest(model, from_50(model), strip_node(120, 90), options);
  EXPECT_EQ(nearest(strip_node(60, 100)), 1);
  EXPECT_FALSE(nearest.weights.other_edge.valid());
}

TEST(FreeEdgeAsOrigin, can_be_named_by_a_node) {
  const Model model = strip();
  WeightOptions options = with(Profile::linear);
  options.origin = Origin::free_edge;
  for (const NodeIndex on : {strip_node(90, 100), strip_node(90, 80)}) {
    const Result<Weights> weights = compute_weights(model, from_50(model), strip_node(120, 20), options, {{}, on});
    ASSERT_TRUE(weights.has_value());
    for (std::size_t i = 0; i < weights->nodes.size(); ++i)
      EXPECT_TRUE(model.position(weights->nodes[i]).y() < 100 || model.position(weights->nodes[i]).x() == 50 || weights->weight[i] == 1);
    EXPECT_EQ(model.position(weights->edge).y(), 100);
  }
  const auto refused = compute_weights(model, from_50(model), strip_node(120, 20), options, {{}, strip_node(0, 0)});
  ASSERT_FALSE(refused.has_value());
  EXPECT_NE(refused.error().message.find("isn't selected"), std::string::npos);
}

TEST(FreeEdgeAsOrigin, is_that_of_the_arm_in_which_the_grab_is) {
  // a T: the stem is held, both arms end free; the arms' sides, which don't reach the rim either, are nearer
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  for (int j = 0; j <= 20; ++j)
    for (int i = 0; i <= 40; ++i) nodes.push_back({1 + i + 41 * j, Vec3(i, j, 0)});
  for (int j = 0; j < 20; ++j)
    for (int i = 0; i < 40; ++i)
      if (j >= 14 || (i >= 16 && i < 24))
        shells.push_back({1 + i + 41 * j, 1, {1 + i + 41 * j, 2 + i + 41 * j, 43 + i + 41 * j, 42 + i + 41 * j}});
  const Model tee = test::make_model(nodes, shells);
  const NodeSet selection = nodes_where(tee, [](const Vec3& p) { return p.y() >= 4; });
  WeightOptions options = with(Profile::linear);
  options.origin = Origin::free_edge;
  const Weighed w(tee, selection, tee.find_node(1 + 8 + 41 * 17), options);
  EXPECT_EQ(w(tee.find_node(1 + 0 + 41 * 17)), 1);
  EXPECT_LT(w(tee.find_node(1 + 40 + 41 * 17)), 1);
}

TEST(FreeEdges, tell_holes_from_the_ends_of_tubes) {
  const auto holes = [](const Model& model) {
    const NodeSet all = nodes_where(model, [](const Vec3&) { return true; });
    const std::vector<std::uint8_t> marks = FreeEdges(model, all).on_holes(std::vector<std::uint8_t>(all.size(), 0));
    return std::count(marks.begin(), marks.end(), 1);
  };
  EXPECT_EQ(holes(strip()), 0);
  EXPECT_EQ(holes(strip_with_hole(100, 50)), 8);
  EXPECT_EQ(holes(tube()), 0);
}

}  // namespace
}  // namespace prismesh::mesh::shape

// Weights on shapes where each distance is known by a formula, and on sections that are stretched by an end.
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/mesh/shape/weighed.h"
#include "tests/support/make_model.h"

namespace prismesh::mesh::shape {
namespace {

using std::numbers::pi;
using test::grid_node;
using test::make_grid;
using test::make_model;
using test::nodes_where;
using test::Weighed;

/// The profiles once more, from their definition in docs/shaping.md.
double profile_by_definition(Profile profile, double flat, double d) {
  if (profile == Profile::constant) return 1;
  if (d == 0) return 0;
  d = std::min(1.0, d / (1 - flat));
  switch (profile) {
    case Profile::linear: return d;
    case Profile::smooth: return 3 * std::pow(d, 2) - 2 * std::pow(d, 3);
    case Profile::sharp: return std::pow(d, 2);
    case Profile::root: return std::pow(d, 0.5);
    case Profile::sphere: return std::sqrt(1 - std::pow(1 - d, 2));
    case Profile::inverse_square: return 1 - std::pow(1 - d, 2);
    default: return (std::exp(-std::pow(3 * (1 - d), 2) / 2) - std::exp(-4.5)) / (1 - std::exp(-4.5));
  }
}

constexpr std::array kEveryNode{Profile::constant, Profile::linear, Profile::smooth,         Profile::sharp,
                                Profile::root,     Profile::sphere, Profile::inverse_square, Profile::gaussian};

/// Compares all weights, under every profile and some flat centres, with the profile of a share d known for each place.
void expect_shares(const Model& model, const NodeSet& selection, NodeIndex grab, WeightOptions options, double tolerance,
                   const std::function<double(const Vec3&)>& share) {
  for (const Profile profile : kEveryNode)
    for (const double flat : {0.0, 0.25, 0.6}) {
      SCOPED_TRACE(std::string(name(profile)) + ", flat " + std::to_string(flat));
      options.falloff.profile = profile;
      options.falloff.flat = flat;
      const Weighed w(model, selection, grab, options);
      for (const NodeIndex node : selection) {
        const double d = share(model.position(node));
        // a root is steep where it begins: allow for a difference in d
        const double low = profile_by_definition(profile, flat, std::max(0.0, d - tolerance));
        const double high = profile_by_definition(profile, flat, std::min(1.0, d + tolerance));
        ASSERT_GE(w(node), low - 1e-12) << model.position(node).transpose();
        ASSERT_LE(w(node), high + 1e-12) << model.position(node).transpose();
      }
    }
}

TEST(WeightsByFormula, on_a_plane_strip) {
  const Model model = make_grid(8, 20, [](int i, int j) { return Vec3(i, j + 0.2 * ((i + j) % 2) * (j > 5 && j < 20), 0); });
  const NodeSet selection = nodes_where(model, [](const Vec3& p) { return p.y() >= 5; });
  expect_shares(model, selection, grid_node(8, 4, 20), {}, 1e-9, [](const Vec3& p) { return (p.y() - 5) / 15; });
}

/// Rings of 96 quads.
Model rings(int count, const std::function<Vec3(int ring, double angle)>& place) {
  constexpr int kAround = 96;
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  for (int r = 0; r <= count; ++r)
    for (int k = 0; k < kAround; ++k) nodes.push_back({1 + k + kAround * r, place(r, 2 * pi * k / kAround)});
  for (int r = 0; r < count; ++r)
    for (int k = 0; k < kAround; ++k) {
      const int a = 1 + k + kAround * r, b = 1 + (k + 1) % kAround + kAround * r;
      shells.push_back({a, 1, {a, b, b + kAround, a + kAround}});
    }
  return make_model(nodes, shells);
}

TEST(WeightsByFormula, on_an_annulus) {
  const Model model = rings(20, [](int r, double angle) { return Vec3((10 + r) * std::cos(angle), (10 + r) * std::sin(angle), 0); });
  const NodeSet selection = nodes_where(model, [](const Vec3& p) { return p.norm() < 25.5; });
  // the border is a polygon: a chord of 96 lies 0.05 % nearer than its ends, the same everywhere along a ring
  expect_shares(model, selection, NodeIndex(7), {}, 0.001, [](const Vec3& p) { return (25 - p.norm()) / 15; });
}

TEST(WeightsByFormula, on_a_cylinder) {
  const Model model = rings(30, [](int r, double angle) { return Vec3(15 * std::cos(angle), 15 * std::sin(angle), r); });
  const NodeSet selection = nodes_where(model, [](const Vec3& p) { return p.z() >= 12; });
  expect_shares(model, selection, NodeIndex(30 * 96 + 5), {}, 1e-9, [](const Vec3& p) { return (p.z() - 12) / 18; });
}

TEST(WeightsByFormula, along_a_slanted_direction) {
  const Model model = make_grid(30, 30, [](int i, int j) { return Vec3(i, j, 0.1 * i); });
  // a diamond, whose rim faces (1, 1) and (-1, -1) on two of its sides
  const NodeSet selection =
      nodes_where(model, [](const Vec3& p) { return std::abs(p.x() + p.y() - 30) <= 10 && std::abs(p.x() - p.y()) <= 14; });
  WeightOptions options;
  options.falloff.along = Vec3(3, 3, 0);
  expect_shares(model, selection, grid_node(30, 17, 15), options, 1e-9, [](const Vec3& p) {
    const double at = p.x() + p.y();
    return at > 32 ? (40 - at) / 8 : at < 32 ? (at - 20) / 12 : 1;
  });
}

constexpr int kLength = 24;
constexpr int kAround = 24;  ///< 6 elements a side

/// A rail of box section: ring k of kAround nodes; `keep(k, i)` says which shells are there.
Model box_rail(const std::function<bool(int around, int along)>& keep) {
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  for (int i = 0; i <= kLength; ++i)
    for (int k = 0; k < kAround; ++k) {
      const int side = k / 6, step = k % 6;
      const std::array<Vec3, 4> corner{Vec3(i, 0, 0), Vec3(i, 6, 0), Vec3(i, 6, 6), Vec3(i, 0, 6)};
      const std::size_t from = static_cast<std::size_t>(side), to = (from + 1) % 4;
      nodes.push_back({1 + k + kAround * i, corner[from] + (corner[to] - corner[from]) * step / 6});
    }
  for (int i = 0; i < kLength; ++i)
    for (int k = 0; k < kAround; ++k) {
      const int a = 1 + k + kAround * i, b = 1 + (k + 1) % kAround + kAround * i;
      if (keep(k, i)) shells.push_back({a, 1, {a, b, b + kAround, a + kAround}});
    }
  return make_model(nodes, shells);
}

NodeIndex rail_node(int around, int along) { return NodeIndex(static_cast<std::size_t>(around + kAround * along)); }

WeightOptions linear_options() {
  WeightOptions options;
  options.falloff.profile = Profile::linear;
  return options;
}

TEST(WeightsOfSections, keep_rows_of_a_closed_rail_evenly_spaced) {
  const Model model = box_rail([](int, int) { return true; });
  const NodeSet selection = nodes_where(model, [](const Vec3& p) { return p.x() >= 9; });
  for (const int grabbed : {0, 2, 12}) {  // on a ridge and off it
    const Weighed w(model, selection, rail_node(grabbed, kLength), linear_options());
    for (const NodeIndex node : selection) EXPECT_NEAR(w(node), (model.position(node).x() - 9) / 15, 1e-9);
  }
}

TEST(WeightsOfSections, move_the_end_of_an_unequally_selected_rail_as_one) {
  const Model model = box_rail([](int, int) { return true; });
  // the far side is selected from 6 on, the near one from 12, and in steps between
  const NodeSet selection = nodes_where(model, [](const Vec3& p) { return p.x() >= 12 - p.y(); });
  const Weighed w(model, selection, rail_node(3, kLength), linear_options());
  for (int k = 0; k < kAround; ++k) {
    EXPECT_EQ(w(rail_node(k, kLength)), 1);
    for (int i = 6; i < kLength; ++i) EXPECT_LE(w(rail_node(k, i)), w(rail_node(k, i + 1)) + 1e-12) << k << ", " << i;
  }
  // on the near side the border lies straight across: even rows there as far as no slanted border is nearer
  for (int i = 12; i <= kLength; ++i) EXPECT_NEAR(w(rail_node(21, i)), (i - 12) / 12.0, 1e-9);
}

TEST(WeightsOfSections, hold_the_end_when_its_row_is_deselected) {
  const Model model = box_rail([](int, int) { return true; });
  const NodeSet selection = nodes_where(model, [](const Vec3& p) { return p.x() >= 9 && p.x() < kLength; });
  const Weighed w(model, selection, std::nullopt, linear_options());
  for (int k = 0; k < kAround; ++k) {
    EXPECT_EQ(w(rail_node(k, kLength - 1)), 0);
    EXPECT_EQ(w(rail_node(k, kLength)), 0);
    EXPECT_EQ(w(rail_node(k, 9)), 0);
  }
  EXPECT_EQ(w(w.weights.grab), 1);
  EXPECT_NEAR(model.position(w.weights.grab).x(), 16, 0.5);
}

TEST(WeightsOfSections, take_the_end_around_a_slot_as_one_edge) {
  // a slot of two elements from the end inwards on one side
  const Model model = box_rail([](int k, int i) { return i < kLength - 5 || k < 2 || k > 3; });
  const NodeSet selection = nodes_where(model, [](const Vec3& p) { return p.x() >= 9; });
  const Weighed w(model, selection, rail_node(14, kLength), linear_options());
  for (int k = 0; k < kAround; ++k) {
    if (k == 3) continue;  // in the slot
    EXPECT_EQ(w(rail_node(k, kLength)), 1) << k;
  }
  // beside the slot, and on the sides without one, rows are even
  for (const int k : {2, 4, 9, 15, 21})
    for (int i = 9; i <= kLength; ++i) EXPECT_NEAR(w(rail_node(k, i)), (i - 9) / 15.0, 1e-9) << k << ", " << i;
}

TEST(WeightsOfSections, leave_a_hole_before_the_end_free) {
  const Model model = box_rail([](int k, int i) { return i < kLength - 4 || i >= kLength - 2 || k < 2 || k > 3; });
  const NodeSet selection = nodes_where(model, [](const Vec3& p) { return p.x() >= 9; });
  const Weighed w(model, selection, rail_node(14, kLength), linear_options());
  for (int k = 0; k < kAround; ++k) EXPECT_EQ(w(rail_node(k, kLength)), 1) << k;
  for (const int k : {2, 4, 9, 15, 21})
    for (int i = 9; i <= kLength; ++i) EXPECT_NEAR(w(rail_node(k, i)), (i - 9) / 15.0, 1e-9) << k << ", " << i;
  // in the hole's shadow paths are longer on one side of it than on the other; nothing turns back
  for (int i = 9; i < kLength - 4; ++i) EXPECT_LT(w(rail_node(3, i)), w(rail_node(3, i + 1)));
}

TEST(WeightsOfSections, choose_among_several_free_edges) {
  // both ends are free and selected, the middle isn't: each end moves alone
  const Model model = box_rail([](int, int) { return true; });
  const NodeSet selection = nodes_where(model, [](const Vec3& p) { return p.x() <= 8 || p.x() >= 14; });
  const Weighed w(model, selection, rail_node(5, kLength), linear_options());
  for (const NodeIndex node : selection) {
    const double x = model.position(node).x();
    EXPECT_NEAR(w(node), x <= 8 ? 0 : (x - 14) / 10, 1e-9);
  }
  EXPECT_EQ(w.weights.unreached, 9u * kAround);
  // the edge nearest to a grab off the edges
  WeightOptions options = linear_options();
  options.origin = Origin::free_edge;
  const Weighed nearest(model, selection, rail_node(5, 6), options);
  for (int k = 0; k < kAround; ++k) EXPECT_EQ(nearest(rail_node(k, 0)), 1);
  EXPECT_NEAR(nearest(rail_node(11, 6)), 0.25, 1e-9);
}

TEST(WeightsOfSections, split_a_grab_where_free_edge_and_border_meet) {
  // an open strip: the grab lies on the rim and on the free side at once
  const Model model = make_grid(10, 10, [](int i, int j) { return Vec3(i, j, 0); });
  const NodeSet selection = nodes_where(model, [](const Vec3& p) { return p.y() >= 4; });
  const Weighed w(model, selection, grid_node(10, 0, 4), linear_options());
  EXPECT_EQ(w(grid_node(10, 0, 4)), 1);
  for (int i = 1; i <= 10; ++i) EXPECT_EQ(w(grid_node(10, i, 4)), 0) << i;
  for (const double weight : w.weights.weight) EXPECT_TRUE(weight >= 0 && weight <= 1);
}

}  // namespace
}  // namespace prismesh::mesh::shape

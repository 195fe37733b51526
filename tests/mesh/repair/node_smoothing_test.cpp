#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "mesh/repair/node_smoothing.h"
#include "tests/mesh/repair/patch_fixture.h"

namespace prismesh::mesh::repair {
namespace {

/// A step: two plates with a slope of 45 degrees, one row of quads wide, between them.
Grid step() {
  return {9, 10, [](double x, double y) { return Vec3(x, y, std::clamp(x - 4, 0.0, 1.0)); }, {}};
}
/// A tube of radius 4 about the y axis, all of it but a slit, whose ends are lines that bend.
Grid open_tube() {
  return {20, 6, [](double x, double y) { return Vec3(4 * std::sin(x / 4), y, 4 * std::cos(x / 4)); }, {}};
}

struct Settled {
  Vec3 before, after;
};

/// The node (i, j), shifted to the place for (i + by_x, j + by_y), settles.
Settled settle_shifted(PatchFixture& fixture, const Grid& grid, std::size_t i, std::size_t j, double by_x, double by_y, bool along_lines) {
  const LocalNode node = fixture.patch.find(at(grid.node(i, j)));
  const Vec3 shifted = grid.place(static_cast<double>(i) + by_x, static_cast<double>(j) + by_y);
  fixture.patch.begin();
  fixture.patch.move(node, shifted);
  smooth_nodes(fixture.context, 30, along_lines);
  return {shifted, fixture.patch.position(node)};
}

TEST(Settling, a_node_on_a_crease_slides_along_it) {
  const Grid grid = step();
  PatchFixture fixture(model_of(grid.positions(), grid.shells()));
  const Settled settled = settle_shifted(fixture, grid, 4, 5, 0, 0.6, true);
  EXPECT_LT(std::abs(settled.after.y() - 5), 0.1);
  EXPECT_NEAR(settled.after.x(), 4, 1e-12);
  EXPECT_NEAR(settled.after.z(), 0, 1e-12);
}

TEST(Settling, a_node_on_a_crease_stays_unless_lines_are_asked_for) {
  const Grid grid = step();
  PatchFixture fixture(model_of(grid.positions(), grid.shells()));
  const Settled settled = settle_shifted(fixture, grid, 4, 5, 0, 0.6, false);
  EXPECT_EQ(settled.after, settled.before);
}

TEST(Settling, a_node_where_lines_meet_stays) {
  const Grid grid = step();
  PatchFixture fixture(model_of(grid.positions(), grid.shells()));
  const Settled settled = settle_shifted(fixture, grid, 4, 10, 0, -0.3, true);
  EXPECT_EQ(settled.after, settled.before);
}

TEST(Settling, a_node_that_has_to_stay_stays_on_its_line) {
  const Grid grid = step();
  Rules rules;
  const std::size_t node = grid.node(4, 5);
  rules.node = [node](NodeIndex n) { return static_cast<std::uint8_t>(n.value == node ? kStays : 0); };
  PatchFixture fixture(model_of(grid.positions(), grid.shells()), rules);
  const Settled settled = settle_shifted(fixture, grid, 4, 5, 0, 0.6, true);
  EXPECT_EQ(settled.after, settled.before);
}

TEST(Settling, no_farther_along_a_line_than_it_may) {
  const Grid grid = step();
  PatchFixture fixture(model_of(grid.positions(), grid.shells()));
  fixture.options.relax.max_move_on_line = 0.05;
  const LocalNode node = fixture.patch.find(at(grid.node(4, 5)));
  const Vec3 home = fixture.patch.position(node);
  // Its neighbours on the line went on, so it would like to follow.
  fixture.patch.begin();
  for (const std::size_t j : {4, 6})
    fixture.patch.move(fixture.patch.find(at(grid.node(4, j))), grid.place(4, static_cast<double>(j) + 0.5));
  fixture.patch.move(node, home);
  smooth_nodes(fixture.context, 30, true);
  const double way = (fixture.patch.position(node) - home).norm();
  EXPECT_GT(way, 0.01);
  EXPECT_LE(way, 0.05);
}

TEST(Settling, an_end_of_a_tube_stays_round) {
  const Grid grid = open_tube();
  PatchFixture fixture(model_of(grid.positions(), grid.shells()));
  const Settled settled = settle_shifted(fixture, grid, 10, 0, 0.6, 0, true);
  EXPECT_LT((settled.after - grid.place(10, 0)).norm(), 0.1);
  EXPECT_NEAR(settled.after.y(), 0, 1e-12);
  EXPECT_NEAR(std::hypot(settled.after.x(), settled.after.z()), 4, 2e-4);
}

TEST(Settling, not_where_a_lines_edge_would_cut_a_bend) {
  // Edges of 1 on a radius of 2: the longer one of them gets, the farther it is from the end's circle.
  const Grid grid{11, 6, [](double x, double y) { return Vec3(2 * std::sin(x / 2), y, 2 * std::cos(x / 2)); }, {}};
  const auto slid = [&](double max_off_surface) {
    PatchFixture fixture(model_of(grid.positions(), grid.shells()));
    fixture.options.max_off_surface = max_off_surface;
    const LocalNode node = fixture.patch.find(at(grid.node(5, 0)));
    const Vec3 home = fixture.patch.position(node);
    fixture.patch.begin();
    for (const std::size_t i : {4, 5, 6})
      fixture.patch.move(fixture.patch.find(at(grid.node(i, 1))), grid.place(static_cast<double>(i) + 0.5, 1), true);
    fixture.patch.move(node, home);
    smooth_nodes(fixture.context, 30, true);
    return (fixture.patch.position(node) - home).norm();
  };
  EXPECT_GT(slid(1.0), 0.1);
  EXPECT_LT(slid(0.02), 0.02);
}

}  // namespace
}  // namespace prismesh::mesh::repair

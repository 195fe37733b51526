#include "mesh/select/outline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "mesh/model/topology_change.h"
#include "tests/support/make_model.h"

namespace prismesh::mesh::select {
namespace {

using Outline = std::vector<std::array<double, 2>>;

constexpr std::array<double, 16> kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

/// Nodes without shells at the places (i, j) / 8 of a square lattice.
Model lattice(int from, int to) {
  std::vector<test::NodeSpec> nodes;
  for (int j = from; j <= to; ++j)
    for (int i = from; i <= to; ++i) nodes.push_back({static_cast<std::int64_t>(nodes.size()) + 1, Vec3(i / 8.0, j / 8.0, 0.25)});
  return test::make_model(nodes, {});
}

/// Winding number by the angle swept: slow, and has nothing in common with counting crossings.
bool winds_around(const Outline& outline, double x, double y) {
  double swept = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const auto& a = outline[i];
    const auto& b = outline[(i + 1) % outline.size()];
    const double ax = a[0] - x, ay = a[1] - y, bx = b[0] - x, by = b[1] - y;
    swept += std::atan2(ax * by - ay * bx, ax * bx + ay * by);
  }
  return std::abs(swept) > 1;
}

/// In eighths, whole numbers throughout: where a point a little to the right of the lattice's and still less above it lies, which is on
/// no border.
bool winds_around_exactly(const std::vector<std::array<std::int64_t, 2>>& outline, std::int64_t x, std::int64_t y) {
  constexpr std::int64_t kFine = 1 << 20;
  const std::int64_t px = x * kFine + 1024, py = y * kFine + 1;
  int winding = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const auto& a = outline[i];
    const auto& b = outline[(i + 1) % outline.size()];
    const std::int64_t ax = a[0] * kFine - px, ay = a[1] * kFine - py, bx = b[0] * kFine - px, by = b[1] * kFine - py;
    const std::int64_t cross = ax * by - bx * ay;
    if (ay < 0 && by > 0 && cross > 0) ++winding;
    if (ay > 0 && by < 0 && cross < 0) --winding;
  }
  return winding != 0;
}

TEST(Outline, takes_what_it_goes_round) {
  const Model model = test::make_grid(60, 60, [](int i, int j) { return Vec3(i / 30.0 - 1, j / 30.0 - 1, 0.3); });
  // a wild lasso of 256 points that crosses its own line
  Outline outline;
  for (int k = 0; k < 256; ++k) {
    const double t = 2 * 3.14159265358979 * k / 256;
    const double r = 0.5 + 0.3 * std::sin(5 * t) + 0.11 * std::cos(17 * t);
    outline.push_back({r * std::cos(t) + 0.2 * std::cos(9 * t) + 0.013, r * std::sin(t) + 0.2 * std::sin(9 * t) - 0.017});
  }
  const NodeSet inside = inside_outline(model, kIdentity, outline);
  NodeSet expected;
  for (std::size_t i = 0; i < model.node_count(); ++i)
    if (winds_around(outline, model.positions[i].x(), model.positions[i].y())) expected.push_back(NodeIndex(i));
  EXPECT_GT(expected.size(), 300u);
  EXPECT_EQ(inside, expected);
  std::reverse(outline.begin(), outline.end());
  EXPECT_EQ(inside_outline(model, kIdentity, outline), expected);
}

TEST(Outline, agrees_with_swept_angles_on_random_outlines) {
  const Model model = test::make_grid(40, 40, [](int i, int j) { return Vec3(i / 20.0 - 1, j / 20.0 - 1, 0.3); });
  std::mt19937 random(5);
  // far beyond the picture too: -3..3
  const auto coordinate = [&] { return static_cast<double>(random() % 1000003) / 1000003 * 6 - 3; };
  std::size_t taken = 0;
  for (int trial = 0; trial < 60; ++trial) {
    Outline outline(3 + random() % 40);
    for (auto& point : outline) point = {coordinate(), coordinate()};
    NodeSet expected;
    for (std::size_t i = 0; i < model.node_count(); ++i)
      if (winds_around(outline, model.positions[i].x(), model.positions[i].y())) expected.push_back(NodeIndex(i));
    EXPECT_EQ(inside_outline(model, kIdentity, outline), expected) << "trial " << trial;
    taken += expected.size();
  }
  EXPECT_GT(taken, 20000u);
}

TEST(Outline, decides_borders_exactly) {
  // corners, sides and nodes fall together everywhere; sides lie on each other, points repeat, spikes go out and back
  const Model model = lattice(-12, 12);
  std::mt19937 random(11);
  std::size_t taken = 0;
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<std::array<std::int64_t, 2>> eighths(3 + random() % 12);
    for (std::size_t k = 0; k < eighths.size(); ++k) {
      eighths[k] = {static_cast<std::int64_t>(random() % 33) - 16, static_cast<std::int64_t>(random() % 33) - 16};
      if (k > 0 && random() % 5 == 0) eighths[k] = eighths[k - 1];
      if (k > 0 && random() % 4 == 0) eighths[k][random() % 2] = eighths[k - 1][random() % 2];
      if (k > 1 && random() % 6 == 0) eighths[k] = eighths[k - 2];
    }
    Outline outline;
    for (const auto& point : eighths) outline.push_back({static_cast<double>(point[0]) / 8, static_cast<double>(point[1]) / 8});
    NodeSet expected;
    for (int j = -12; j <= 12; ++j)
      for (int i = -12; i <= 12; ++i)
        if (winds_around_exactly(eighths, i, j)) expected.emplace_back(static_cast<std::size_t>((j + 12) * 25 + i + 12));
    EXPECT_EQ(inside_outline(model, kIdentity, outline), expected) << "trial " << trial;
    taken += expected.size();
  }
  EXPECT_GT(taken, 20000u);
}

TEST(Outline, sees_through_the_view_and_not_behind_the_eye) {
  const Model model = test::make_model({{1, {0, 0, -2}}, {2, {0, 0, 2}}, {3, {3, 0, -2}}, {4, {1.9, 0, -4}}}, {});
  // a pinhole looking down -z: x/-z, y/-z
  const std::array<double, 16> view{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -1, 0, 0, 0, 0};
  EXPECT_EQ(inside_outline(model, view, {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}), (NodeSet{NodeIndex(0), NodeIndex(3)}));
}

TEST(Outline, takes_nothing_that_was_removed) {
  Model model = test::make_model({{1, {0, 0, 0}}, {2, {1, 0, 0}}}, {});
  remove_node(model, NodeIndex(0));
  EXPECT_EQ(inside_outline(model, kIdentity, {{-9, -9}, {9, -9}, {9, 9}, {-9, 9}}), NodeSet{NodeIndex(1)});
}

TEST(Outline, of_less_than_an_area_takes_nothing) {
  const Model model = lattice(0, 8);
  EXPECT_TRUE(inside_outline(model, kIdentity, {}).empty());
  EXPECT_TRUE(inside_outline(model, kIdentity, {{-9, -9}, {9, 9}}).empty());
  EXPECT_TRUE(inside_outline(model, kIdentity, {{-9, 1}, {9, 1}, {3, 1}}).empty());
  EXPECT_TRUE(inside_outline(model, kIdentity, {{-9, -9}, {9, NAN}, {9, 9}}).empty());
  EXPECT_TRUE(inside_outline(model, kIdentity, {{-9, 1}, {9, 1}, {3, 1 + 1e-320}}).empty());
}

TEST(Outline, counts_a_shared_border_once) {
  // two squares side by side, and two triangles at a slanting side: each node belongs to exactly one
  const Model model = lattice(0, 8);
  const NodeSet left = inside_outline(model, kIdentity, {{-1, -1}, {0.5, -1}, {0.5, 2}, {-1, 2}});
  const NodeSet right = inside_outline(model, kIdentity, {{0.5, -1}, {2, -1}, {2, 2}, {0.5, 2}});
  EXPECT_EQ(left.size() + right.size(), 81u);
  EXPECT_EQ(left.size(), 36u) << "what lies on a border to its left counts";
  const NodeSet upper = inside_outline(model, kIdentity, {{-1, -1}, {2, 2}, {-1, 2}});
  const NodeSet lower = inside_outline(model, kIdentity, {{-1, -1}, {2, -1}, {2, 2}});
  EXPECT_EQ(upper.size() + lower.size(), 81u);
}

}  // namespace
}  // namespace prismesh::mesh::select

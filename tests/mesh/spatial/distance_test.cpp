#include "mesh/spatial/distance.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "tests/support/make_model.h"

namespace prismesh::mesh::spatial {
namespace {

NodeSet nodes(std::initializer_list<std::size_t> indices) {
  NodeSet set;
  for (const std::size_t i : indices) set.push_back(NodeIndex(i));
  return set;
}
ShellSet shells(std::size_t begin, std::size_t end) {
  ShellSet set;
  for (std::size_t i = begin; i < end; ++i) set.push_back(ShellIndex(i));
  return set;
}

struct Pair {
  const char* what;
  Triangle a, b;
  double distance;
};

TEST(Distance, pairs_of_triangles) {
  const Pair pairs[] = {
      {"one above the other", {{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}}, {{{1, 1, 2}, {2, 1, 2}, {1, 2, 2}}}, 2},
      {"corner over the inside", {{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}}, {{{1, 1, 3}, {1, 1, 9}, {2, 1, 9}}}, 3},
      {"edge across edge", {{{-1, 0, 0}, {1, 0, 0}, {0, 0, -5}}}, {{{0, -1, 1}, {0, 1, 1}, {0, 0, 5}}}, 1},
      {"crossing", {{{-1, -1, 0}, {1, -1, 0}, {0, 2, 0}}}, {{{0, 0, -1}, {0, 0, 1}, {5, 5, 5}}}, 0},
      {"corner to corner", {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}, {{{4, 4, 0}, {4, 5, 0}, {5, 4, 0}}}, std::sqrt(2 * 3.5 * 3.5)},
      {"parallel edges", {{{0, 0, 0}, {2, 0, 0}, {1, -1, 0}}}, {{{1, 3, 0}, {4, 3, 0}, {2, 5, 0}}}, 3},
      {"point over a triangle", {{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}}, {{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}}, 1},
      {"two points", {{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}}, {{{3, 4, 0}, {3, 4, 0}, {3, 4, 0}}}, 5},
  };
  for (const Pair& pair : pairs) {
    for (const bool swap : {false, true}) {
      const Nearest nearest = swap ? nearest_of_triangles(pair.b, pair.a) : nearest_of_triangles(pair.a, pair.b);
      EXPECT_NEAR(std::sqrt(nearest.distance2), pair.distance, 1e-12) << pair.what;
      EXPECT_NEAR((nearest.on_a - nearest.on_b).norm(), pair.distance, 1e-12) << pair.what;
      const auto off = [](const Vec3& point, const Triangle& triangle) {
        return std::sqrt(nearest_of_triangles({point, point, point}, triangle).distance2);
      };
      EXPECT_NEAR(off(nearest.on_a, swap ? pair.b : pair.a), 0, 1e-7) << pair.what;
      EXPECT_NEAR(off(nearest.on_b, swap ? pair.a : pair.b), 0, 1e-7) << pair.what;
    }
  }
}

/// No pair of points of the two triangles, taken densely, is nearer than the answer, and one comes close to it.
TEST(Distance, random_triangles_against_dense_points) {
  std::mt19937 random(21);
  std::uniform_real_distribution<double> anywhere(-1, 1);
  const auto point = [&] { return Vec3(anywhere(random), anywhere(random), anywhere(random)); };
  constexpr int kSteps = 24;
  for (int trial = 0; trial < 60; ++trial) {
    const Triangle a = {point(), point(), point()};
    const Vec3 away(trial % 3, 0, 0);
    const Triangle b = {point() + away, point() + away, point() + away};
    const auto at = [](const Triangle& t, int i, int j) {
      return Vec3(t[0] + (t[1] - t[0]) * (double(i) / kSteps) + (t[2] - t[0]) * (double(j) / kSteps));
    };
    double least = 1e9;
    for (int i = 0; i <= kSteps; ++i)
      for (int j = 0; i + j <= kSteps; ++j)
        for (int k = 0; k <= kSteps; ++k)
          for (int l = 0; k + l <= kSteps; ++l) least = std::min(least, (at(a, i, j) - at(b, k, l)).norm());
    const double distance = std::sqrt(nearest_of_triangles(a, b).distance2);
    EXPECT_LE(distance, least + 1e-12);
    EXPECT_GE(distance, least - 0.15);
  }
}

TEST(Distance, nodes_to_nodes_and_nodes_to_shells) {
  const Model model = test::make_shells({{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}, {5, 5, 7}, {5, 5, 9}}, {{0, 1, 2, 3}});
  const auto between_nodes = shortest_distance(model, {nodes({0, 1}), {}}, {nodes({4, 5}), {}});
  ASSERT_TRUE(between_nodes);
  EXPECT_NEAR(between_nodes->distance, std::sqrt(25 + 25 + 49.0), 1e-12);
  EXPECT_EQ(between_nodes->b.node, NodeIndex(std::size_t{4}));
  const auto to_surface = shortest_distance(model, {nodes({4, 5}), {}}, {{}, shells(0, 1)});
  EXPECT_DOUBLE_EQ(to_surface->distance, 7);
  EXPECT_EQ(to_surface->a.node, NodeIndex(std::size_t{4}));
  EXPECT_FALSE(to_surface->a.shell.valid());
  EXPECT_EQ(to_surface->b.shell, ShellIndex(std::size_t{0}));
  EXPECT_NEAR((to_surface->b.point - Vec3(5, 5, 0)).norm(), 0, 1e-12);
  EXPECT_FALSE(shortest_distance(model, {}, {nodes({0}), {}}));
}

TEST(Distance, a_quad_counts_on_both_sides_of_its_diagonal) {
  const Model model = test::make_shells({{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}, {9, 4, 3}, {4, 9, 4}}, {{0, 1, 2, 3}});
  const auto first_half = shortest_distance(model, {nodes({4}), {}}, {{}, shells(0, 1)});
  const auto second_half = shortest_distance(model, {nodes({5}), {}}, {{}, shells(0, 1)});
  ASSERT_TRUE(first_half && second_half);
  EXPECT_DOUBLE_EQ(first_half->distance, 3);
  EXPECT_DOUBLE_EQ(second_half->distance, 4);
  EXPECT_NEAR((second_half->b.point - Vec3(4, 9, 0)).norm(), 0, 1e-12);
}

TEST(Distance, two_wavy_sheets_as_by_trying_every_pair) {
  std::vector<Vec3> points;
  std::vector<std::array<int, 4>> quads;
  constexpr int kSide = 12;
  for (int sheet = 0; sheet < 2; ++sheet) {
    const int base = static_cast<int>(points.size());
    for (int j = 0; j <= kSide; ++j)
      for (int i = 0; i <= kSide; ++i)
        points.emplace_back(i + 0.3 * sheet, j, 2.5 * sheet + std::sin(0.7 * i + 2 * sheet) * std::cos(0.5 * j));
    for (int j = 0; j < kSide; ++j)
      for (int i = 0; i < kSide; ++i) {
        const int a = base + j * (kSide + 1) + i;
        quads.push_back({a, a + 1, a + kSide + 2, a + kSide + 1});
      }
  }
  const Model model = test::make_shells(points, quads);
  const std::size_t half = quads.size() / 2;
  double least = 1e9;
  for (std::size_t s = 0; s < half; ++s)
    for (std::size_t t = half; t < quads.size(); ++t)
      for (const int first : {1, 2})
        for (const int second : {1, 2}) {
          const auto corner = [&](std::size_t shell, int c) {
            return points[static_cast<std::size_t>(quads[shell][static_cast<std::size_t>(c)])];
          };
          const Triangle a = {corner(s, 0), corner(s, first), corner(s, first + 1)};
          const Triangle b = {corner(t, 0), corner(t, second), corner(t, second + 1)};
          least = std::min(least, nearest_of_triangles(a, b).distance2);
        }
  const auto closest = shortest_distance(model, {{}, shells(0, half)}, {{}, shells(half, quads.size())});
  ASSERT_TRUE(closest);
  EXPECT_DOUBLE_EQ(closest->distance, std::sqrt(least));
  EXPECT_LT(closest->a.shell.value, half);
  EXPECT_GE(closest->b.shell.value, half);
}

TEST(Distance, a_bent_quad_counts_along_the_diagonal_from_its_first_corner) {
  // a valley at z = 0 along that diagonal; the other one would be a ridge at z = 2
  const Model model = test::make_shells({{0, 0, 0}, {2, 0, 2}, {2, 2, 0}, {0, 2, 2}, {1.5, 1.5, -1}}, {{0, 1, 2, 3}});
  const auto below = shortest_distance(model, {nodes({4}), {}}, {{}, shells(0, 1)});
  ASSERT_TRUE(below);
  EXPECT_DOUBLE_EQ(below->distance, 1);
  EXPECT_LT((below->b.point - Vec3(1.5, 1.5, 0)).norm(), 1e-15);
  EXPECT_EQ(below->a.point, Vec3(1.5, 1.5, -1));
}

}  // namespace
}  // namespace prismesh::mesh::spatial

#include "mesh/spatial/surface_distance.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "tests/support/make_model.h"
#include "tests/support/whole_model.h"

namespace prismesh::mesh::spatial {
namespace {

using test::all_shells;
using test::make_model;

/// A tube about z of so many quads, radius and height.
Model tube(int around, int up, double radius, double height) {
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  for (int j = 0; j <= up; ++j)
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * M_PI * i / around;
      nodes.push_back({1 + i + around * j, Vec3(radius * std::cos(angle), radius * std::sin(angle), height * j / up)});
    }
  for (int j = 0; j < up; ++j)
    for (int i = 0; i < around; ++i) {
      const int next = (i + 1) % around;
      shells.push_back(
          {1 + i + around * j, 1, {1 + i + around * j, 1 + next + around * j, 1 + next + around * (j + 1), 1 + i + around * (j + 1)}});
    }
  return make_model(nodes, shells);
}

std::vector<Vec3> scattered(std::size_t count, const Vec3& low, const Vec3& high) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(0, 1);
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < count; ++i)
    points.push_back(low + (high - low).cwiseProduct(Vec3(share(random), share(random), share(random))));
  return points;
}

/// Every triangle is asked, by another way than the tree's: the best of very many points on its sides and of the foot on its plane.
double by_trying_all(const Model& model, const Vec3& point) {
  double least = std::numeric_limits<double>::infinity();
  const auto triangle = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    const auto side = [&](const Vec3& p, const Vec3& q) {
      const double s = std::clamp((point - p).dot(q - p) / (q - p).squaredNorm(), 0.0, 1.0);
      least = std::min(least, (p + s * (q - p) - point).norm());
    };
    side(a, b);
    side(b, c);
    side(c, a);
    const Vec3 normal = (b - a).cross(c - a).normalized();
    const Vec3 foot = point - (point - a).dot(normal) * normal;
    const double inside[3] = {(b - a).cross(foot - a).dot(normal), (c - b).cross(foot - b).dot(normal),
                              (a - c).cross(foot - c).dot(normal)};
    if (inside[0] >= 0 && inside[1] >= 0 && inside[2] >= 0) least = std::min(least, (foot - point).norm());
  };
  for (std::size_t s = 0; s < model.shell_count(); ++s) {
    const auto corner = [&](std::size_t c) { return model.position(model.shell_nodes[s].node[c]); };
    triangle(corner(0), corner(1), corner(2));
    if (!model.shell_nodes[s].is_triangle()) triangle(corner(0), corner(2), corner(3));
  }
  return least;
}

TEST(SurfaceDistanceTest, is_the_height_over_a_plate) {
  const Model plate = make_model({{1, {0, 0, 0}}, {2, {10, 0, 0}}, {3, {10, 10, 0}}, {4, {0, 10, 0}}}, {{1, 1, {1, 2, 3, 4}}});
  const ShellTree tree(plate, all_shells(plate));
  const auto found = distances_to(tree, std::vector<Vec3>{{1, 2, 3}, {9, 9, -0.25}, {5, 5, 0}, {13, 14, 0}});
  ASSERT_TRUE(found);
  EXPECT_EQ(*found, (std::vector<double>{3, 0.25, 0, 5}));
}

TEST(SurfaceDistanceTest, is_the_difference_of_radii_between_concentric_tubes) {
  const Model outer = tube(720, 4, 50, 100);
  const Model inner = tube(720, 4, 47, 100);
  std::vector<Vec3> points;
  for (std::size_t n = 0; n < inner.node_count(); ++n) points.push_back(inner.positions[n]);
  const auto found = distances_to(ShellTree(outer, all_shells(outer)), points);
  ASSERT_TRUE(found);
  const double sagitta = 50 * (1 - std::cos(M_PI / 720));
  for (const double distance : *found) {
    EXPECT_LE(distance, 3 + 1e-12);
    EXPECT_GE(distance, 3 - sagitta - 1e-12);
  }
}

TEST(SurfaceDistanceTest, agrees_with_asking_every_triangle) {
  const Model model = tube(24, 6, 20, 60);
  std::vector<Vec3> points = scattered(700, Vec3(-30, -30, -10), Vec3(30, 30, 70));
  for (const Vec3& far : scattered(20, Vec3(1e4, -1e4, 0), Vec3(2e4, 1e4, 1))) points.push_back(far);
  const auto found = distances_to(ShellTree(model, all_shells(model)), points);
  ASSERT_TRUE(found);
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_NEAR((*found)[i], by_trying_all(model, points[i]), 1e-9) << i;
}

TEST(SurfaceDistanceTest, agrees_with_the_closest_point_whatever_the_order) {
  const Model model = tube(60, 20, 20, 60);
  const ShellTree tree(model, all_shells(model));
  std::vector<Vec3> points = scattered(3000, Vec3(-30, -30, -10), Vec3(30, 30, 70));
  const auto found = distances_to(tree, points);
  std::vector<Vec3> backwards(points.rbegin(), points.rend());
  const auto again = distances_to(tree, backwards);
  ASSERT_TRUE(found && again);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ((*found)[i], tree.closest(points[i])->distance);
    EXPECT_EQ((*found)[i], (*again)[points.size() - 1 - i]);
  }
}

TEST(SurfaceDistanceTest, gives_no_number_where_there_is_none) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  const Model plate =
      make_model({{1, {0, 0, 0}}, {2, {1, 0, 0}}, {3, {1, 1, 0}}, {4, {nan, 0, 0}}}, {{1, 1, {1, 2, 3}}, {2, 1, {1, 2, 4}}});
  const auto found = distances_to(ShellTree(plate, all_shells(plate)), std::vector<Vec3>{{0.5, 0.2, nan}, {0.5, 0.2, 2}, {infinity, 0, 0}});
  ASSERT_TRUE(found);
  EXPECT_TRUE(std::isnan((*found)[0]));
  EXPECT_EQ((*found)[1], 2);
  EXPECT_TRUE(std::isnan((*found)[2]));
  const auto none = distances_to(ShellTree(plate, {}), std::vector<Vec3>{{0, 0, 0}});
  ASSERT_TRUE(none);
  EXPECT_TRUE(std::isnan(none->front()));
}

TEST(SurfaceDistanceTest, counts_lone_nodes_as_points) {
  const Model model = make_model({{1, {0, 0, 0}}, {2, {1, 0, 0}}, {3, {1, 1, 0}}, {4, {5, 0, 0}}}, {{1, 1, {1, 2, 3}}});
  const ShellTree tree(model, all_shells(model), {NodeIndex(std::size_t{3})});
  const auto found = distances_to(tree, std::vector<Vec3>{{5, 0, 2}, {0.9, 0.1, 1}});
  ASSERT_TRUE(found);
  EXPECT_DOUBLE_EQ((*found)[0], 2);
  EXPECT_DOUBLE_EQ((*found)[1], 1);
  EXPECT_FALSE(tree.closest(Vec3(5, 0, 2))->shell.valid());
}

TEST(SurfaceDistanceTest, stops_when_told_to) {
  const Model model = tube(24, 6, 20, 60);
  const auto found =
      distances_to(ShellTree(model, all_shells(model)), scattered(10, Vec3::Zero(), Vec3::Ones()), [](double) { return false; });
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().message, "cancelled");
}

}  // namespace
}  // namespace prismesh::mesh::spatial

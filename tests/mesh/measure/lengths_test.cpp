// Measures between nodes: known angles, circles and ways along surfaces.
#include "mesh/measure/lengths.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "tests/support/make_model.h"

namespace prismesh::mesh::measure {
namespace {

using test::make_model;
using test::NodeSpec;
using test::ShellSpec;

TEST(Lengths, angles) {
  EXPECT_NEAR(*angle_degrees({1, 0, 0}, {0, 0, 0}, {0, 5, 0}), 90, 1e-12);
  EXPECT_NEAR(*angle_degrees({1, 0, 0}, {0, 0, 0}, {-3, 0, 0}), 180, 1e-12);
  EXPECT_NEAR(*angle_degrees({1, 0, 0}, {0, 0, 0}, {7, 0, 0}), 0, 1e-12);
  EXPECT_NEAR(*angle_degrees({2, 1, 1}, {1, 1, 1}, {1 + std::cos(1e-7), 1 + std::sin(1e-7), 1}), 1e-7 * 57.29577951308232, 1e-14)
      << "small angles keep their digits";
  EXPECT_NEAR(*angle_degrees({1e300, 0, 0}, {0, 0, 0}, {0, 1e-300, 0}), 90, 1e-12);
  EXPECT_FALSE(angle_degrees({1, 0, 0}, {1, 0, 0}, {0, 5, 0}));
  EXPECT_FALSE(angle_degrees({1, 0, 0}, {0, 5, 0}, {0, 5, 0}));
}

TEST(Lengths, circles_through_points_of_known_ones) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 200; ++i) {
    const Vec3 centre = 100 * Vec3(unit(random), unit(random), unit(random));
    const Vec3 x = Vec3(unit(random), unit(random), unit(random)).normalized();
    const Vec3 y = x.unitOrthogonal();
    const double radius = std::pow(10, 4 * unit(random));
    const auto at = [&](double angle) -> Vec3 { return centre + radius * (std::cos(angle) * x + std::sin(angle) * y); };
    const std::optional<Circle> circle = circle_through(at(0.1), at(1.4), at(3.9));
    ASSERT_TRUE(circle);
    EXPECT_NEAR(circle->radius, radius, 1e-9 * (radius + 100));
    EXPECT_LT((circle->centre - centre).norm(), 1e-9 * (radius + 100));
    EXPECT_GT(circle->normal.dot(x.cross(y)), 0.999);
  }
  EXPECT_FALSE(circle_through({0, 0, 0}, {1, 1, 1}, {5, 5, 5})) << "on a line";
  EXPECT_FALSE(circle_through({0, 0, 0}, {0, 0, 0}, {5, 5, 5})) << "two at one place";
  EXPECT_FALSE(circle_through({0, 0, 0}, {0, 0, 0}, {0, 0, 0}));
  EXPECT_NEAR(circle_through({1e200, 0, 0}, {0, 1e200, 0}, {-1e200, 0, 0})->radius, 1e200, 1e190);
}

/// A sheet of 10 x `rows` quads of side 1, bent by a right angle at x = 5, and a triangle far off.
Model angle_profile(int rows) {
  std::vector<NodeSpec> nodes;
  std::vector<ShellSpec> shells;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= 10; ++i) nodes.push_back({j * 11 + i + 1, Vec3(std::min(i, 5), j, std::max(0, i - 5))});
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < 10; ++i) {
      const std::int64_t first = j * 11 + i + 1;
      shells.push_back({j * 10 + i + 1, 1, {first, first + 1, first + 12, first + 11}});
    }
  nodes.push_back({9001, {100, 0, 0}});
  nodes.push_back({9002, {101, 0, 0}});
  nodes.push_back({9003, {100, 1, 0}});
  shells.push_back({9001, 2, {9001, 9002, 9003}});
  nodes.push_back({9009, {3, 3, 3}});
  return make_model(nodes, shells);
}

TEST(Lengths, along_a_bent_sheet_is_that_of_the_flat_one) {
  const Model model = angle_profile(4);
  const NodeIndex corner = model.find_node(1), opposite = model.find_node(4 * 11 + 11);
  EXPECT_NEAR(*length_along_surface(model, corner, opposite), std::hypot(10, 4), 1e-9);
  EXPECT_NEAR(*length_along_surface(model, opposite, corner), std::hypot(10, 4), 1e-9);
  EXPECT_NEAR(*length_along_surface(model, corner, model.find_node(2)), 1, 1e-12);
  EXPECT_EQ(*length_along_surface(model, corner, corner), 0);
}

TEST(Lengths, there_is_no_way_between_sheets) {
  const Model model = angle_profile(4);
  const NodeIndex corner = model.find_node(1);
  EXPECT_FALSE(length_along_surface(model, corner, model.find_node(9001)));
  EXPECT_FALSE(length_along_surface(model, corner, model.find_node(9009))) << "a node that no shell has";
  EXPECT_FALSE(length_along_surface(model, model.find_node(9009), corner));
  const std::vector<std::uint8_t> hidden{1, 0};
  EXPECT_FALSE(length_along_surface(model, corner, model.find_node(2), hidden)) << "a hidden part leads nowhere";
}

/// A spiral whose ends are close together, but far along the sheet.
TEST(Lengths, finds_ways_much_longer_than_the_straight_one) {
  constexpr int kSteps = 200;
  std::vector<NodeSpec> nodes;
  std::vector<ShellSpec> shells;
  double length = 0;
  Vec3 before = Vec3::Zero();
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = 2 * 3.14159265358979 * 0.98 * i / kSteps;
    const Vec3 at(50 * std::cos(angle), 50 * std::sin(angle), 0);
    if (i > 0) length += (at - before).norm();
    before = at;
    nodes.push_back({2 * i + 1, at});
    nodes.push_back({2 * i + 2, at + Vec3(0, 0, 2)});
    if (i > 0) shells.push_back({i, 1, {2 * i - 1, 2 * i + 1, 2 * i + 2, 2 * i}});
  }
  const Model model = make_model(nodes, shells);
  EXPECT_NEAR(*length_along_surface(model, model.find_node(1), model.find_node(2 * kSteps + 1)), length, 1e-6 * length);
}

TEST(Lengths, of_nodes_at_one_place) {
  const Model model =
      make_model({{1, {0, 0, 0}}, {2, {1, 0, 0}}, {3, {1, 1, 0}}, {4, {0, 0, 0}}, {5, {9, 9, 9}}}, {{1, 1, {1, 2, 3}}, {2, 1, {4, 3, 2}}});
  EXPECT_NEAR(*length_along_surface(model, model.find_node(1), model.find_node(4)), 2, 1e-9) << "over the common edge and back";
  EXPECT_FALSE(length_along_surface(model, model.find_node(1), model.find_node(5)));
}

TEST(Lengths, measures_of_two_and_three_nodes) {
  const Model model = angle_profile(4);
  const std::vector<NodeIndex> two{model.find_node(1), model.find_node(11)};
  const NodeMeasures of_two = measure_nodes(model, two);
  EXPECT_EQ(of_two.between, Vec3(5, 0, 5));
  EXPECT_NEAR(of_two.distance, std::sqrt(50.0), 1e-12);
  EXPECT_NEAR(*of_two.along_surface, 10, 1e-9);
  EXPECT_FALSE(of_two.angle);
  const std::vector<NodeIndex> three{model.find_node(1), model.find_node(6), model.find_node(11)};
  const NodeMeasures of_three = measure_nodes(model, three);
  EXPECT_NEAR(*of_three.angle, 90, 1e-12);
  EXPECT_NEAR(of_three.circle->radius, std::sqrt(50.0) / 2, 1e-12);
  EXPECT_LT((of_three.circle->centre - Vec3(2.5, 0, 2.5)).norm(), 1e-12);
}

}  // namespace
}  // namespace prismesh::mesh::measure

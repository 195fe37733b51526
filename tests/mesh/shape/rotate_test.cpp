#include "mesh/shape/rotate.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

namespace prismesh::mesh::shape {
namespace {

const Axis kAboutZ{Vec3::Zero(), Vec3::UnitZ()};

std::vector<Vec3> rotated(const std::vector<Vec3>& start, const std::vector<double>& weight, const Axis& axis, double degrees,
                          std::optional<double> max_move = std::nullopt) {
  std::vector<Vec3> out(start.size());
  rotate(start, weight, {axis, degrees, max_move}, out);
  return out;
}

TEST(Rotate, quarter_turns_are_exact) {
  const std::vector<Vec3> start{{3, 4, 5}, {-7.25, 0.1, -2}};
  const std::vector<double> whole{1, 1};
  for (const double turns : {-4.0, 0.0, 4.0, 8.0}) EXPECT_EQ(rotated(start, whole, kAboutZ, 90 * turns), start);
  EXPECT_EQ(rotated(start, whole, kAboutZ, 90)[0], Vec3(-4, 3, 5));
  EXPECT_EQ(rotated(start, whole, kAboutZ, 180)[0], Vec3(-3, -4, 5));
  EXPECT_EQ(rotated(start, whole, kAboutZ, -90)[1], Vec3(0.1, 7.25, -2));
  EXPECT_EQ(rotated(start, {0.5, 0.25}, kAboutZ, 360)[0], Vec3(-3, -4, 5));
  EXPECT_EQ(rotated(start, {0.5, 0.25}, kAboutZ, 360)[1], Vec3(-0.1, -7.25, -2));
}

TEST(Rotate, a_turn_by_nothing_leaves_every_bit) {
  const std::vector<Vec3> start{{0.1, 0.2, 0.3}, {1.0 / 3, -1e-9, 7.7}, {123.456, 0.7, -0.1}};
  const Axis axis{Vec3(1e3 + 0.1, -7.3, 1.0 / 7), unit_of(Vec3(1, 2, 3)).value()};
  EXPECT_EQ(rotated(start, {1, 1, 1}, axis, 0), start);
  EXPECT_EQ(rotated(start, {0, 0, 0}, axis, 33), start);
}

TEST(Rotate, is_right_handed_about_any_axis) {
  const Axis axis{Vec3(1, 2, 3), unit_of(Vec3(1, 1, 1)).value()};
  // a third of a turn about the diagonal takes x to y to z
  const Vec3 out = rotated({axis.point + Vec3(2, 0, 0)}, {1}, axis, 120)[0];
  EXPECT_LT((out - (axis.point + Vec3(0, 2, 0))).norm(), 1e-14);
}

TEST(Rotate, every_node_keeps_to_its_circle) {
  const Axis axis{Vec3(10, -3, 2), unit_of(Vec3(0.3, -2, 1)).value()};
  std::vector<Vec3> start;
  std::vector<double> weight;
  for (int i = 0; i < 2000; ++i) {
    start.emplace_back(std::sin(i) * 40, std::cos(3 * i) * 30, i * 0.01);
    weight.push_back(i / 2000.0);
  }
  const std::vector<Vec3> out = rotated(start, weight, axis, 77.7);
  for (std::size_t i = 0; i < start.size(); ++i) {
    // the oracle: Eigen's rotation with the C library's sine
    const Vec3 expected = axis.point + Eigen::AngleAxisd(weight[i] * 77.7 * M_PI / 180, axis.direction) * (start[i] - axis.point);
    ASSERT_LT((out[i] - expected).norm(), 1e-12);
  }
}

TEST(Rotate, a_bent_strip_keeps_its_length_where_it_moves_as_one) {
  // a flange of 20 rows: the first ten bend, the rest turn as one
  std::vector<Vec3> start;
  std::vector<double> weight;
  for (int i = 0; i <= 20; ++i) {
    start.emplace_back(5.0 * i, 0, 0);
    weight.push_back(std::min(1.0, i / 10.0));
  }
  const std::vector<Vec3> out = rotated(start, weight, kAboutZ, 60);
  for (std::size_t i = 0; i <= 20; ++i) {
    EXPECT_NEAR(out[i].norm(), start[i].norm(), 1e-13);
    EXPECT_NEAR(std::atan2(out[i].y(), out[i].x()), i == 0 ? 0 : weight[i] * M_PI / 3, 1e-14);
  }
  for (std::size_t i = 10; i < 20; ++i) EXPECT_NEAR((out[i + 1] - out[i]).norm(), 5, 1e-13);
}

TEST(Rotate, a_limit_stops_on_the_circle) {
  std::vector<Vec3> out(3);
  const std::vector<Vec3> start{{1, 0, 0}, {10, 0, 0}, {100, 0, 7}};
  EXPECT_EQ(rotate(start, std::vector<double>{1, 1, 1}, {kAboutZ, -170, 3.0}, out), 2u);
  EXPECT_NEAR((out[0] - start[0]).norm(), 2 * std::sin(85 * M_PI / 180), 1e-14);
  for (const std::size_t i : {1u, 2u}) {
    EXPECT_NEAR((out[i] - start[i]).norm(), 3, 1e-12);
    EXPECT_NEAR(out[i].head<2>().norm(), start[i].x(), 1e-12);
    EXPECT_LT(out[i].y(), 0);
    EXPECT_EQ(out[i].z(), start[i].z());
  }
}

TEST(Rotate, what_is_no_angle_gives_no_coordinates) {
  for (const double degrees : {1e9, -1e300, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
    EXPECT_FALSE(rotated({Vec3(1, 0, 0)}, {1}, kAboutZ, degrees)[0].allFinite());
}

TEST(Rotate, directions_of_any_length) {
  EXPECT_EQ(unit_of(Vec3(0, -3e-300, 0)), Vec3(0, -1, 0));
  EXPECT_EQ(unit_of(Vec3(1e300, 0, 0)), Vec3(1, 0, 0));
  EXPECT_FALSE(unit_of(Vec3::Zero()));
  EXPECT_FALSE(unit_of(Vec3(0, std::numeric_limits<double>::infinity(), 0)));
  EXPECT_FALSE(unit_of(Vec3(0, std::numeric_limits<double>::quiet_NaN(), 1)));
}

TEST(Rotate, the_limit_counts_from_the_axis_wherever_it_is) {
  const Axis axis{Vec3(100, 0, -4), Vec3::UnitZ()};
  const std::vector<Vec3> start{{110, 0, 5}, {110, 0, 5}};
  std::vector<Vec3> out(2);
  EXPECT_EQ(rotate(start, std::vector<double>{1, 0.1}, {axis, 170, 3.0}, out), 1u) << "a tenth of the turn goes 2.96";
  EXPECT_NEAR((out[0] - start[0]).norm(), 3, 1e-12);
  EXPECT_NEAR((out[0] - Vec3(100, 0, 5)).norm(), 10, 1e-12);
  EXPECT_GT(out[0].y(), 0);
  EXPECT_NEAR((out[1] - start[1]).norm(), 2 * 10 * std::sin(8.5 * M_PI / 180), 1e-12);
  EXPECT_EQ(rotate(start, std::vector<double>{1, 0.1}, {axis, 180, 15.0}, out), 1u);
  EXPECT_NEAR((out[0] - start[0]).norm(), 15, 1e-12) << "farther than the axis, less far than the circle is wide";
  EXPECT_EQ(rotate(start, std::vector<double>{1, 1}, {axis, 180, 20.0}, out), 0u) << "no node can be farther than the circle is wide";
  EXPECT_LT((out[0] - Vec3(90, 0, 5)).norm(), 1e-12);
}

}  // namespace
}  // namespace prismesh::mesh::shape

#include "mesh/contact/orientation.h"

#include <cmath>

#include <gtest/gtest.h>

namespace prismesh::mesh::contact {
namespace {

TEST(Orientation, is_above_zero_on_the_side_from_which_the_corners_turn_counterclockwise) {
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
  EXPECT_GT(orientation(a, b, c, {0.3, 0.3, 1}), 0);
  EXPECT_LT(orientation(a, b, c, {0.3, 0.3, -1}), 0);
  EXPECT_EQ(orientation(a, b, c, {7, -3, 0}), 0);
  EXPECT_LT(orientation(b, a, c, {0.3, 0.3, 1}), 0);
}

TEST(Orientation, decides_one_ulp_from_a_plane) {
  const Vec3 a(12, 12, 24), b(24, 24, 48), c(0.5, 12, 12.5);  // x + y = z
  EXPECT_GT(orientation(b, a, c, {1, 0, 0}), 0);
  for (int i = -30; i <= 30; ++i) {
    const double value = orientation(b, a, c, {0.75 + i * 0x1p-53, 0.5, 1.25});
    EXPECT_EQ((value > 0) - (value < 0), (i > 0) - (i < 0)) << i;
  }
}

TEST(Orientation, is_exact_where_differences_round) {
  // 0.1 and 1e17 have no common double between them: the differences themselves are rounded
  const Vec3 a(1e17, 0, 0), b(1e17, 0.1, 0), c(0.1, 0, 0.1);
  const Vec3 in_plane(0.1, 5, 0.1);
  EXPECT_EQ(orientation(a, b, c, in_plane), 0);
  EXPECT_NE(orientation(a, b, c, {std::nextafter(0.1, 1.0), 5, 0.1}), 0);
  EXPECT_NE(orientation(a, b, c, {0.1, 5, std::nextafter(0.1, 0.0)}), 0);
  EXPECT_GT(orientation(a, b, c, {std::nextafter(0.1, 1.0), 5, 0.1}) * orientation(a, b, c, {1, 5, 0.1}), 0);
}

TEST(Orientation, changes_sign_with_each_swap_and_not_with_a_shift_on_the_grid) {
  const Vec3 a(0, 0, 0), b(1, 3, 0x1p-20), c(2, 6 + 0x1p-20, 5), d(3, 9, 3 * 0x1p-20);
  EXPECT_EQ(orientation(a, b, c, d), 0) << "a, b, d lie on a line";
  const Vec3 e = d + Vec3(0, 0x1p-20, 0);
  const double sign = orientation(a, b, c, e);
  EXPECT_NE(sign, 0);
  EXPECT_LT(sign * orientation(b, a, c, e), 0);
  EXPECT_LT(sign * orientation(a, c, b, e), 0);
  EXPECT_LT(sign * orientation(a, b, e, c), 0);
  const Vec3 shift(12345 + 0x1p-20, -777, 1e6);
  EXPECT_GT(sign * orientation(a + shift, b + shift, c + shift, e + shift), 0);
  EXPECT_EQ(orientation(a + shift, b + shift, c + shift, d + shift), 0);
}

TEST(Orientation, knows_three_points_on_a_line) {
  EXPECT_TRUE(on_a_line({0, 0, 0}, {1, 2, 3}, {2, 4, 6}));
  EXPECT_TRUE(on_a_line({1, 1, 1}, {1, 1, 1}, {2, 4, 6}));
  EXPECT_FALSE(on_a_line({0, 0, 0}, {1, 2, 3}, {2, 4, std::nextafter(6.0, 7.0)}));
  EXPECT_FALSE(on_a_line({0.1, 0.2, 0.3}, {0.2, 0.4, 0.6}, {0.3, 0.6, 0.9})) << "0.3 isn't the sum of 0.1 and 0.2";
}

}  // namespace
}  // namespace prismesh::mesh::contact

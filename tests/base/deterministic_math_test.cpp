#include "base/deterministic_math.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace prismesh {
namespace {

TEST(DeterministicMath, exp_agrees_with_the_library) {
  for (double x = -700; x < 700; x += 0.37109375) EXPECT_NEAR(deterministic_exp(x) / std::exp(x), 1.0, 1e-15) << x;
  EXPECT_EQ(deterministic_exp(0), 1.0);
  EXPECT_EQ(deterministic_exp(-1000), 0.0);
  EXPECT_NEAR(deterministic_exp(-740) / std::exp(-740.0), 1.0, 1e-2);  // few digits left down there
  EXPECT_TRUE(std::isinf(deterministic_exp(710)));
  EXPECT_FALSE(std::isinf(deterministic_exp(709.7)));
  EXPECT_TRUE(std::isnan(deterministic_exp(std::numeric_limits<double>::quiet_NaN())));
}

TEST(DeterministicMath, sine_and_cosine_of_degrees) {
  for (double degrees = -800; degrees < 800; degrees += 0.734375) {
    const double radians = degrees * (kPi / 180);
    EXPECT_NEAR(deterministic_cos_degrees(degrees), std::cos(radians), 4e-15) << degrees;
    EXPECT_NEAR(deterministic_sin_degrees(degrees), std::sin(radians), 4e-15) << degrees;
  }
  EXPECT_EQ(deterministic_cos_degrees(90), 0.0);
  EXPECT_EQ(deterministic_cos_degrees(-180), -1.0);
  EXPECT_EQ(deterministic_sin_degrees(270), -1.0);
  EXPECT_EQ(deterministic_sin_degrees(360), 0.0);
}

TEST(DeterministicMath, angles) {
  for (double angle = -3.14; angle < 3.14; angle += 0.00390625)
    EXPECT_NEAR(deterministic_atan2(7 * std::sin(angle), 7 * std::cos(angle)), angle, 1e-15 + 4e-16 * std::abs(angle));
  EXPECT_EQ(deterministic_atan2(0, 0), 0.0);
  EXPECT_EQ(deterministic_atan2(0, -2), kPi);
  EXPECT_EQ(deterministic_atan2(-3, 0), -kPi / 2);
  for (double x = -1; x <= 1; x += 0.001953125) EXPECT_NEAR(deterministic_acos(x), std::acos(x), 2e-15) << x;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_NEAR(deterministic_atan2(kInfinity, kInfinity), kPi / 4, 1e-15);
  EXPECT_NEAR(deterministic_atan2(1, -kInfinity), kPi, 1e-15);
  EXPECT_EQ(deterministic_acos(1.5), 0.0);
  EXPECT_EQ(deterministic_acos(-1.5), kPi);
}

}  // namespace
}  // namespace prismesh

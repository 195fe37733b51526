#include "base/deterministic_math.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

// Only operations that IEEE 754 rounds exactly (+ - * / sqrt floor) appear here, and the build forbids contraction.

namespace prismesh {

namespace {

/// 2^n for -1022 <= n <= 1023.
double power_of_two(int n) { return std::bit_cast<double>(static_cast<std::uint64_t>(n + 1023) << 52); }

/// Taylor series for |x| <= pi/4; the first term left out is below 1e-17.
double small_sin(double x) {
  const double z = x * x;
  double sum = 0;
  for (int n = 17; n >= 3; n -= 2) sum = -z / (n * (n - 1)) * (sum + 1.0);
  return x + x * sum;
}
double small_cos(double x) {
  const double z = x * x;
  double sum = 0;
  for (int n = 18; n >= 2; n -= 2) sum = -z / (n * (n - 1)) * (sum + 1.0);
  return 1.0 + sum;
}

/// Arc tangent for 0 <= x <= 1: turned back by the nearest of five known angles, then the series for |t| <= 1/8.
double small_atan(double x) {
  constexpr double kAngle[5] = {0, 0.24497866312686415417, 0.46364760900080611621, 0.64350110879328438680, 0.78539816339744830962};
  const int k = static_cast<int>(std::floor(x * 4 + 0.5));
  const double c = 0.25 * k;
  const double t = (x - c) / (1.0 + x * c);
  const double z = t * t;
  double sum = 0;
  for (int n = 19; n >= 3; n -= 2) sum = z * (1.0 / n - sum);
  return kAngle[k] + (t - t * sum);
}

}  // namespace

double deterministic_exp(double x) {
  if (std::isnan(x)) return x;
  if (x > 709.782712893384) return std::numeric_limits<double>::infinity();
  if (x < -745.13321910194122) return 0;
  // x = n ln 2 + r; ln 2 in two parts so that r keeps its digits
  constexpr double kLn2High = 0x1.62e42fee00000p-1, kLn2Low = 0x1.a39ef35793c76p-33;
  const double n = std::floor(x * 1.4426950408889634 + 0.5);
  const double r = (x - n * kLn2High) - n * kLn2Low;
  double sum = 0;
  for (int k = 14; k >= 2; --k) sum = (sum + 1.0) * r / k;
  const double value = 1.0 + (r + r * sum);
  // in two steps, since 2^n alone may leave the range of normal numbers
  const int half = static_cast<int>(n) / 2;
  return value * power_of_two(half) * power_of_two(static_cast<int>(n) - half);
}

double deterministic_sin_degrees(double degrees) { return deterministic_cos_degrees(degrees - 90.0); }

double deterministic_cos_degrees(double degrees) {
  const double quarter = std::floor(degrees / 90.0 + 0.5);
  const double rest = (degrees - 90.0 * quarter) / kDegreesPerRadian;
  switch (static_cast<std::int64_t>(quarter) & 3) {
    case 0: return small_cos(rest);
    case 1: return -small_sin(rest);
    case 2: return -small_cos(rest);
    default: return small_sin(rest);
  }
}

double deterministic_atan2(double y, double x) {
  const double along = std::abs(x), across = std::abs(y);
  const double longer = std::max(along, across);
  if (!(longer > 0)) return 0;
  const double share = std::min(along, across) / longer;
  double angle = small_atan(share <= 1 ? share : 1.0);  // infinity by infinity: 45 degrees, as the C library has it
  if (across > along) angle = kPi / 2 - angle;
  if (x < 0) angle = kPi - angle;
  return y < 0 ? -angle : angle;
}

double deterministic_acos(double x) {
  x = std::clamp(x, -1.0, 1.0);
  return deterministic_atan2(std::sqrt((1.0 - x) * (1.0 + x)), x);
}

}  // namespace prismesh

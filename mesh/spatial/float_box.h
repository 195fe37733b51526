// Boxes in single precision that contain what they are made of: low corners are rounded down, high corners up.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "mesh/model/model.h"

namespace prismesh::mesh::spatial {

/// Four numbers that are computed together.
using Float4 = float __attribute__((vector_size(16)));

inline constexpr float kMaxFloat = std::numeric_limits<float>::max();
inline constexpr float kInfiniteFloat = std::numeric_limits<float>::infinity();

/// The nearest float that isn't above / below a finite number.
inline float rounded_down(double value) {
  if (value > kMaxFloat) return kMaxFloat;
  if (value < -kMaxFloat) return -kInfiniteFloat;
  const auto near = static_cast<float>(value);
  return near > value ? std::nextafter(near, -kInfiniteFloat) : near;
}
inline float rounded_up(double value) { return -rounded_down(-value); }

struct FloatBox {
  std::array<float, 3> low{kInfiniteFloat, kInfiniteFloat, kInfiniteFloat};
  std::array<float, 3> high{-kInfiniteFloat, -kInfiniteFloat, -kInfiniteFloat};

  bool empty() const { return low[0] > high[0]; }
  bool operator==(const FloatBox&) const = default;
  void add(const Vec3& point) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], rounded_down(point[static_cast<Eigen::Index>(axis)]));
      high[axis] = std::max(high[axis], rounded_up(point[static_cast<Eigen::Index>(axis)]));
    }
  }
  void add(const FloatBox& other) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], other.low[axis]);
      high[axis] = std::max(high[axis], other.high[axis]);
    }
  }
};

/// Bounds a square of distances that is computed in single precision: what is truly within `square` is below the bound.
inline float bound_of_square(double square) { return rounded_up(square * (1 + 2e-6)); }

/// The square of the distance of two boxes, a little more or less by rounding; infinite where one is empty.
inline float distance2(const FloatBox& a, const FloatBox& b) {
  if (a.empty() || b.empty()) return kInfiniteFloat;
  float sum = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float gap = std::max({0.0F, a.low[axis] - b.high[axis], b.low[axis] - a.high[axis]});
    sum += gap * gap;
  }
  return sum;
}

}  // namespace prismesh::mesh::spatial

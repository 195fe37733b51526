#include "mesh/spatial/curve_order.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace prismesh::mesh::spatial {

namespace {

/// Spreads the lowest 21 bits: two zeros between neighbours.
std::uint64_t spread(std::uint64_t bits) {
  bits = (bits | bits << 32) & 0x001f00000000ffff;
  bits = (bits | bits << 16) & 0x001f0000ff0000ff;
  bits = (bits | bits << 8) & 0x100f00f00f00f00f;
  bits = (bits | bits << 4) & 0x10c30c30c30c30c3;
  return (bits | bits << 2) & 0x1249249249249249;
}

}  // namespace

std::vector<std::uint32_t> along_curve(std::span<const Vec3> points, double shift) {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Vec3& point : points)
    if (point.allFinite()) {
      low = low.cwiseMin(point);
      high = high.cwiseMax(point);
    }
  const double extent = (high - low).maxCoeff(), widest = extent * (1 + shift);
  low.array() -= extent * shift;
  // where the extent is 0 or too large for a double, the points keep their order
  const double per_length = 2097151.0 / widest;
  const double cells = widest > 0 && std::isfinite(widest) && std::isfinite(per_length) ? per_length : 0;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keyed;
  keyed.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite()) continue;
    std::uint64_t key = 0;
    if (cells > 0) {
      const Vec3 cell = (points[i] - low) * cells;
      for (int axis = 0; axis < 3; ++axis) key |= spread(static_cast<std::uint64_t>(cell[axis])) << axis;
    }
    keyed.emplace_back(key, static_cast<std::uint32_t>(i));
  }
  std::sort(keyed.begin(), keyed.end());
  std::vector<std::uint32_t> order;
  order.reserve(keyed.size());
  for (const auto& [key, point] : keyed) order.push_back(point);
  return order;
}

}  // namespace prismesh::mesh::spatial

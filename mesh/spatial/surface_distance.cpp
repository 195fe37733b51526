#include "mesh/spatial/surface_distance.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "base/parallel_for.h"

namespace prismesh::mesh::spatial {

namespace {

constexpr std::size_t kPointsAtOnce = 512;            ///< in one range, in which each search starts at the result before it
constexpr std::size_t kPointsBetweenReports = 65536;  ///< after which the progress is told

/// Spreads the lowest 21 bits: two zeros between neighbours.
std::uint64_t spread(std::uint64_t bits) {
  bits = (bits | bits << 32) & 0x001f00000000ffff;
  bits = (bits | bits << 16) & 0x001f0000ff0000ff;
  bits = (bits | bits << 8) & 0x100f00f00f00f00f;
  bits = (bits | bits << 4) & 0x10c30c30c30c30c3;
  return (bits | bits << 2) & 0x1249249249249249;
}

/// Sorts the finite points along a space-filling curve [Morton 1966], so that neighbours in the list are near each other.
std::vector<std::uint32_t> along_curve(std::span<const Vec3> points) {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Vec3& point : points)
    if (point.allFinite()) {
      low = low.cwiseMin(point);
      high = high.cwiseMax(point);
    }
  const double widest = (high - low).maxCoeff();
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

}  // namespace

Result<std::vector<double>> distances_to(const ShellTree& tree, std::span<const Vec3> points, const Progress& progress) {
  std::vector<double> distances(points.size(), std::numeric_limits<double>::quiet_NaN());
  if (tree.empty()) return distances;
  const std::vector<std::uint32_t> order = along_curve(points);
  for (std::size_t slice = 0; slice < order.size(); slice += kPointsBetweenReports) {
    if (progress && !progress(static_cast<double>(slice) / static_cast<double>(order.size()))) return fail(cancelled());
    parallel_for(std::min(kPointsBetweenReports, order.size() - slice), kPointsAtOnce, [&](std::size_t begin, std::size_t end) {
      Vec3 near = tree.some_point();
      for (std::size_t i = slice + begin; i < slice + end; ++i) distances[order[i]] = tree.distance(points[order[i]], near);
    });
  }
  return distances;
}

}  // namespace prismesh::mesh::spatial

#include "mesh/spatial/surface_distance.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "base/parallel_for.h"
#include "mesh/spatial/curve_order.h"

namespace prismesh::mesh::spatial {

namespace {

constexpr std::size_t kPointsAtOnce = 512;            ///< in one range, in which each search starts at the result before it
constexpr std::size_t kPointsBetweenReports = 65536;  ///< after which the progress is told

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

#include "mesh/lod/choose.h"

#include <algorithm>

namespace prismesh::mesh::lod {

namespace {

/// A node that was removed and the triangle in its place may have moved apart, each by `moved`.
bool is_fine(const Group& group, double moved, const Viewpoint& from, const Limits& limits) {
  const Vec3 way = group.sphere.centre - from.eye;
  const double scale = from.away.norm(), middle = scale > 0 ? way.dot(from.away) : way.norm();
  const double distance = std::max(middle - (scale > 0 ? scale : 1) * (group.sphere.radius + moved), from.nearest);
  return (group.error + 2 * moved) * from.pixels_at_distance_1 <= limits.error_pixels * distance &&
         group.side * from.pixels_at_distance_1 <= limits.side_pixels * distance;
}

}  // namespace

/// A group's error, side and movement aren't smaller than those inside it, and its sphere holds theirs: so if it is fine enough, all inside
/// it are. Of the clusters over each other exactly one is fine enough while what replaces it isn't.
void choose(const Levels& levels, std::span<const float> moved, const Viewpoint& from, const Limits& limits,
            std::vector<std::uint32_t>& clusters) {
  std::vector<std::uint8_t> fine(levels.groups.size());
  for (std::size_t g = 0; g < levels.groups.size(); ++g)
    fine[g] = is_fine(levels.groups[g], moved.empty() ? 0 : moved[g], from, limits) ? 1 : 0;
  for (std::size_t c = 0; c < levels.clusters.size(); ++c) {
    const Cluster& cluster = levels.clusters[c];
    if (cluster.made_by != kNoGroup && fine[cluster.made_by] == 0) continue;
    if (cluster.replaced_by != kNoGroup && fine[cluster.replaced_by] != 0) continue;
    clusters.push_back(static_cast<std::uint32_t>(c));
  }
}

std::size_t triangles_of(const Levels& levels, std::span<const std::uint32_t> clusters) {
  std::size_t triangles = 0;
  for (const std::uint32_t c : clusters) triangles += levels.clusters[c].count * (c < levels.shell_clusters ? 2U : 1U);
  return triangles;
}

}  // namespace prismesh::mesh::lod

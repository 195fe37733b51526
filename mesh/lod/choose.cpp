#include "mesh/lod/choose.h"

#include <algorithm>

namespace prismesh::mesh::lod {

namespace {

bool is_fine(const Group& group, const Viewpoint& from, double max_pixels) {
  const double distance = std::max((group.sphere.centre - from.eye).norm() - group.sphere.radius, from.nearest);
  return group.error * from.pixels_at_distance_1 <= max_pixels * distance;
}

}  // namespace

/// A group's error isn't smaller than those inside it, and its sphere holds theirs: so if it is fine enough, all inside it are. Of the
/// clusters over each other exactly one is fine enough while what replaces it isn't.
void choose(const Levels& levels, const std::vector<std::uint8_t>& held, const Viewpoint& from, double max_pixels,
            std::vector<std::uint32_t>& clusters) {
  std::vector<std::uint8_t> fine(levels.groups.size());
  for (std::size_t g = 0; g < levels.groups.size(); ++g)
    fine[g] = (held.empty() || held[g] == 0) && is_fine(levels.groups[g], from, max_pixels) ? 1 : 0;
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

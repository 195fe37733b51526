#include <algorithm>

#include "mesh/lod/levels.h"

namespace prismesh::mesh::lod {

std::vector<float> added_errors(const Levels& levels, std::span<const float> by_cluster) {
  std::vector<float> added(levels.groups.size());
  const auto raise = [&](std::uint32_t group, float error) {
    if (group != kNoGroup) added[group] = std::max(added[group], error);
  };
  for (std::size_t c = 0; c < levels.shell_clusters; ++c) raise(levels.clusters[c].replaced_by, by_cluster[c]);
  for (std::size_t g = 0; g < levels.groups.size(); ++g) {
    if (added[g] == 0) continue;
    const Group& group = levels.groups[g];
    for (std::uint32_t c = group.first_cluster; c < group.first_cluster + group.clusters; ++c)
      raise(levels.clusters[c].replaced_by, added[g]);
  }
  return added;
}

}  // namespace prismesh::mesh::lod

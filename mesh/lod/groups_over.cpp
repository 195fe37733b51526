#include "mesh/lod/levels.h"

namespace prismesh::mesh::lod {

std::vector<std::uint8_t> groups_over(const Levels& levels, const std::vector<std::uint8_t>& shells) {
  std::vector<std::uint8_t> over(levels.groups.size());
  for (std::size_t c = 0; c < levels.shell_clusters; ++c) {
    const Cluster& cluster = levels.clusters[c];
    if (cluster.replaced_by == kNoGroup || over[cluster.replaced_by] != 0) continue;
    for (std::uint32_t i = 0; i < cluster.count; ++i)
      if (shells[levels.shells[cluster.first + i].value] != 0) over[cluster.replaced_by] = 1;
  }
  for (std::size_t g = 0; g < levels.groups.size(); ++g) {
    if (over[g] == 0) continue;
    const Group& group = levels.groups[g];
    for (std::uint32_t c = group.first_cluster; c < group.first_cluster + group.clusters; ++c)
      if (levels.clusters[c].replaced_by != kNoGroup) over[levels.clusters[c].replaced_by] = 1;
  }
  return over;
}

}  // namespace prismesh::mesh::lod

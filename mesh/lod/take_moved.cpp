#include <limits>

#include "mesh/lod/levels.h"
#include "mesh/lod/sphere_maker.h"
#include "mesh/model/adjacency.h"

namespace prismesh::mesh::lod {

void take_moved(const Model& model, const std::vector<NodeIndex>& moved, Levels& levels) {
  std::vector<std::uint8_t> is_moved(model.shell_count());
  for (const NodeIndex node : moved)
    for (const ShellIndex shell : model.adjacency->shells_of(node)) is_moved[shell.value] = 1;
  std::vector<std::uint8_t> stale(levels.groups.size());
  for (std::size_t c = 0; c < levels.shell_clusters; ++c) {
    Cluster& cluster = levels.clusters[c];
    bool any = false;
    for (std::uint32_t i = 0; i < cluster.count && !any; ++i) any = is_moved[levels.shells[cluster.first + i].value] != 0;
    if (!any) continue;
    cluster.bounds = bounds_of_shells(model, levels, cluster);
    if (cluster.replaced_by != kNoGroup) stale[cluster.replaced_by] = 1;
  }
  for (std::size_t g = 0; g < levels.groups.size(); ++g) {
    if (stale[g] == 0) continue;
    Group& group = levels.groups[g];
    group.error = std::numeric_limits<double>::infinity();
    for (std::uint32_t c = group.first_cluster; c < group.first_cluster + group.clusters; ++c)
      if (levels.clusters[c].replaced_by != kNoGroup) stale[levels.clusters[c].replaced_by] = 1;
  }
}

}  // namespace prismesh::mesh::lod

#include "mesh/document/followed_edges.h"

#include "mesh/document/plan_motion.h"
#include "mesh/model/adjacency.h"

namespace prismesh::mesh::document {

Result<std::vector<std::array<NodeIndex, 2>>> find_followed_edges(const Generation& generation, const Edit& edit) {
  constexpr double kWhole = 1 - 1e-9;  // weights carried across welds are interpolated
  const Result<Motion> motion = plan_motion(generation, edit, nullptr);
  if (!motion) return fail(motion.error());
  const Adjacency& adjacency = *generation.model.adjacency;
  std::vector<std::array<NodeIndex, 2>> edges;
  for (std::size_t i = 0; i < motion->nodes.size(); ++i) {
    const NodeIndex node = motion->nodes[i];
    if (!(motion->weight[i] >= kWhole)) continue;
    for (std::uint32_t e = adjacency.edge_first[node.value]; e < adjacency.edge_first[node.value + 1]; ++e) {
      if (adjacency.edge_shell_first[e + 1] - adjacency.edge_shell_first[e] != 1) continue;
      const std::uint32_t other = motion->place_of(adjacency.edge_high[e]);
      if (other != Motion::Follower::kStays && motion->weight[other] >= kWhole) edges.push_back({node, adjacency.edge_high[e]});
    }
  }
  return edges;
}

}  // namespace prismesh::mesh::document

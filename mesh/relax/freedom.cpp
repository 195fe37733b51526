#include "mesh/relax/freedom.h"

#include "base/deterministic_math.h"
#include "base/parallel_for.h"
#include "mesh/relax/feature_lines.h"

namespace prismesh::mesh::relax {

namespace {

constexpr std::size_t kNodesAtOnce = 2048;

Freedom freedom_of(const Model& model, NodeIndex node, double cos_limit) {
  if (model.adjacency->shells_of(node).empty() || !model.position(node).allFinite()) return Freedom::fixed;
  const LineEnds ends = line_ends(model, node, cos_limit, true);
  if (ends.count == 0) return Freedom::surface;
  return passes_through(model, node, ends, cos_limit) ? Freedom::line : Freedom::fixed;
}

}  // namespace

std::vector<Freedom> node_freedoms(const Model& model, const NodeSet& nodes, double feature_angle) {
  const double cos_limit = deterministic_cos_degrees(feature_angle);
  std::vector<Freedom> freedoms(nodes.size());
  parallel_for(nodes.size(), kNodesAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) freedoms[i] = freedom_of(model, nodes[i], cos_limit);
  });
  return freedoms;
}

}  // namespace prismesh::mesh::relax

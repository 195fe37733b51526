#include "mesh/relax/freedom.h"

#include "base/deterministic_math.h"
#include "base/parallel_for.h"
#include "mesh/relax/feature_lines.h"

namespace prismesh::mesh::relax {

namespace {

constexpr std::size_t kFreedomGrain = 2048;

constexpr double kNoAngle = -2;  ///< as a cosine: nothing is sharper

/// `crease_cos`: of the angle of creases, `bend_cos`: of lines that end in a corner.
Freedom freedom_with(const Model& model, NodeIndex node, double crease_cos, double bend_cos) {
  if (model.adjacency->shells_of(node).empty() || !model.position(node).allFinite()) return Freedom::fixed;
  const LineEnds ends = line_ends(model, node, crease_cos, true);
  if (ends.count == 0) return Freedom::surface;
  return passes_through(model, node, ends, bend_cos) ? Freedom::line : Freedom::fixed;
}

}  // namespace

Freedom freedom_of(const Model& model, NodeIndex node, double feature_cos) { return freedom_with(model, node, feature_cos, feature_cos); }

Freedom freedom_by_borders(const Model& model, NodeIndex node, double feature_cos) {
  return freedom_with(model, node, kNoAngle, feature_cos);
}

std::vector<Freedom> node_freedoms(const Model& model, const NodeSet& nodes, double feature_angle) {
  const double feature_cos = deterministic_cos_degrees(feature_angle);
  std::vector<Freedom> freedoms(nodes.size());
  parallel_for(nodes.size(), kFreedomGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) freedoms[i] = freedom_of(model, nodes[i], feature_cos);
  });
  return freedoms;
}

}  // namespace prismesh::mesh::relax

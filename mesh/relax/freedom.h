// How a node may move when a mesh is relaxed or repaired, so that parts keep their shape.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/model/model.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::relax {

enum class Freedom : std::uint8_t {
  fixed,    ///< at a corner: an end, a bend or a junction of feature lines; or in no shell
  line,     ///< on a feature line (free edge, crease, junction, border between parts): it may move along the line
  surface,  ///< inside a smooth sheet: it may move over the surface
};

/// The freedom of each node. Edges between shells of different parts count as feature lines. `feature_angle` in degrees: creases are
/// sharper than that, and a line bends at a corner by more than that. Cost: the shells about `nodes`.
std::vector<Freedom> node_freedoms(const Model& model, const NodeSet& nodes, double feature_angle);

/// The freedom of one node; `feature_cos` is the cosine of the feature angle.
Freedom freedom_of(const Model& model, NodeIndex node, double feature_cos);
/// The same without creases: only free edges, junctions and borders between parts are feature lines. Moving nodes doesn't change it.
Freedom freedom_by_borders(const Model& model, NodeIndex node, double feature_cos);

}  // namespace prismesh::mesh::relax

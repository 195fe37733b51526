// How far a node may go when a mesh is relaxed or repaired: the shape of parts must stay.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/model/model.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::relax {

enum class Freedom : std::uint8_t {
  fixed,    ///< a corner: an end, a bend or a meeting of feature lines; a node of no shell
  line,     ///< on a feature line (free edge, crease, junction, border between parts): it may go along that
  surface,  ///< inside a smooth sheet
};

/// The freedom of each node. Edges between shells of different parts count as feature lines. `feature_angle` in degrees: creases are
/// sharper than that, and a line bends at a corner by more than that. Cost: the shells about `nodes`.
std::vector<Freedom> node_freedoms(const Model& model, const NodeSet& nodes, double feature_angle);

/// Of one node; `feature_cos` is the angle's cosine.
Freedom freedom_of(const Model& model, NodeIndex node, double feature_cos);
/// The same where only free edges, junctions and borders between parts are feature lines: what doesn't change when nodes move.
Freedom freedom_by_borders(const Model& model, NodeIndex node, double feature_cos);

}  // namespace prismesh::mesh::relax

// Surface normals, oriented consistently across a selection: neighbours in real decks often disagree.
#pragma once

#include <vector>

#include "mesh/model/model.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::shape {

/// Unit normal at each node of `nodes` (area-weighted over the shells touching the selection, oriented by spreading from the
/// shells at `reference`, whose first shell keeps its own sense); zero where no shell with an area touches the node. Never NaN.
std::vector<Vec3> oriented_normals(const Model& model, const NodeSet& nodes, NodeIndex reference);

}  // namespace prismesh::mesh::shape

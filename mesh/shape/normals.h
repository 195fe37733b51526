// Computes surface normals with one orientation across a selection: in real decks neighbours are often oriented differently.
#pragma once

#include <vector>

#include "mesh/model/model.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::shape {

/// Returns the unit normal at each of `nodes`: area-weighted over the shells that touch the selection. The orientation spreads from the
/// first shell at `reference`, which keeps its own. Zero where no shell with an area touches the node. Never NaN.
std::vector<Vec3> oriented_normals(const Model& model, const NodeSet& nodes, NodeIndex reference);

}  // namespace prismesh::mesh::shape

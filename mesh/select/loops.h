// Selects loops of free edges.
#pragma once

#include "mesh/model/in_sight.h"
#include "mesh/model/model.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::select {

/// Returns the nodes, mid-side nodes included, of the loop of free edges (edges of one shell) nearest to `place`. The nearest is found
/// along the surface from the shells `start`, by distances along edges and diagonals. The loop follows its sheet: where several loops meet
/// in a node it continues around the same shells; at a junction it takes the sheet with the smallest turn, below 45 degrees; it ends where
/// there is none or the next shell is hidden. Empty if the piece at `start` has no free edge.
NodeSet free_edge_loop(const Model& model, const ShellSet& start, const Vec3& place, OutOfSight out_of_sight);

}  // namespace prismesh::mesh::select

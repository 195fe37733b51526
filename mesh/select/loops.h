// The line along which a sheet ends.
#pragma once

#include "mesh/model/model.h"
#include "mesh/model/node_set.h"
#include "mesh/select/in_sight.h"

namespace prismesh::mesh::select {

/// The nodes, mid-side nodes included, of the loop of free edges that is nearest to `place` along the surface, from the shells `start`
/// on; distances along edges and diagonals. A free edge has one shell. The loop follows its sheet: where several of its kind meet in a node
/// it goes on around the same shells, over a junction into the sheet that lies straight on (within 45 degrees), and ends where there is
/// none or what comes is out of sight. Empty if the piece at `start` has no free edge.
NodeSet free_edge_loop(const Model& model, const ShellSet& start, const Vec3& place, OutOfSight out_of_sight);

}  // namespace prismesh::mesh::select

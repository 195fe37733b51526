// Smooths nodes after a change of the shells about them: moves each in turn to the nearby position where its shells have the best quality.
#pragma once

#include "mesh/repair/context.h"

namespace prismesh::mesh::repair {

/// Smooths the nodes that the patch's current change touched and that may be moved, in `sweeps` with a step that gets smaller.
/// `along_lines`: nodes on feature lines as well, along these.
void smooth_nodes(const RepairContext& context, int sweeps, bool along_lines);

}  // namespace prismesh::mesh::repair

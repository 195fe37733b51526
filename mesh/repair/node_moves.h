// Operations that move nodes and keep the structure. Refusals as in redivide.h.
#pragma once

#include "mesh/repair/context.h"
#include "mesh/repair/reshaping.h"

namespace prismesh::mesh::repair {

/// Marks the shells about a shell's corners as changed, so that their nodes are smoothed. Moves nothing itself.
Refusal mark_neighbourhood_changed(const RepairContext& context, LocalShell shell);

/// Moves a node to `distance` from the surface, along the normal; deck's length unit.
Refusal lift_node(const RepairContext& context, LocalNode node, double distance);

}  // namespace prismesh::mesh::repair

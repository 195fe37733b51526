// Operations that move nodes and keep the structure. Refusals as in redivide.h.
#pragma once

#include "mesh/repair/context.h"
#include "mesh/repair/reshaping.h"

namespace prismesh::mesh::repair {

/// Changes nothing, but counts the shells about a shell's corners as changed, so that their nodes settle.
Refusal stir(const RepairContext& context, LocalShell shell);

/// Moves a node along the surface's normal.
Refusal lift_node(const RepairContext& context, LocalNode node, double distance);

}  // namespace prismesh::mesh::repair

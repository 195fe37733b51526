// Moves nodes after a change of the structure about them: each in turn to the place near it where its shells are best.
#pragma once

#include "mesh/repair/context.h"

namespace prismesh::mesh::repair {

/// Moves nodes that the change touched, and that may be moved, to where their shells are best; `along_lines`: those on feature lines too.
void settle(const RepairContext& context, int sweeps, bool along_lines);

}  // namespace prismesh::mesh::repair

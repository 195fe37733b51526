// Carries out one operation on named shells or nodes.
#pragma once

#include "base/error.h"
#include "mesh/repair/operation.h"
#include "mesh/repair/repair_input.h"
#include "mesh/repair/restructuring.h"

namespace prismesh::mesh::repair {

/// Splits a quad, or two shells across their common edge; collapses a shell's shortest edge, two shells' common edge, or the edge between
/// two nodes; merges two triangles; or swaps the common edge of two shells. Where there are several ways (which diagonal, which ends) it
/// takes the one whose worst shell has the highest composite by the criteria; a single quad is split by the diagonal nearer to the surface.
/// Returns the change of the model. Errors: why the operation is impossible there, for example "shell 12 and shell 40 have no edge in
/// common".
Result<Restructuring> apply_manual_operation(const RepairInput& input, const ManualOperation& manual);

}  // namespace prismesh::mesh::repair

// One operation on named shells or nodes.
#pragma once

#include "base/error.h"
#include "mesh/repair/operation.h"
#include "mesh/repair/repair_input.h"
#include "mesh/repair/restructuring.h"

namespace prismesh::mesh::repair {

/// One operation by hand: split a shell, or two across their common edge; collapse a shell's shortest edge, two shells' common edge, or the
/// edge between two `nodes`; merge two triangles; swap the edge of two shells. `judge` settles what is left open (which diagonal). Errors:
/// why it can't be done there, as a sentence that ends what the edit says ("shell 12 and shell 40 have no edge in common").
Result<Restructuring> by_hand(const RepairInput& input, const ManualOperation& manual);

}  // namespace prismesh::mesh::repair

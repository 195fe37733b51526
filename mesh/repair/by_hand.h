// One operation on named shells or nodes.
#pragma once

#include <span>

#include "base/error.h"
#include "mesh/model/model.h"
#include "mesh/relax/reference_surface.h"
#include "mesh/repair/operation.h"
#include "mesh/repair/options.h"
#include "mesh/repair/restructuring.h"
#include "mesh/repair/rules.h"

namespace prismesh::mesh::repair {

/// One operation by hand: split a shell, or two across their common edge; collapse a shell's shortest edge, two shells' common edge, or the
/// edge between two `nodes`; merge two triangles; swap the edge of two shells. `judge` settles what is left open (which diagonal). Errors:
/// why it can't be done there, as a sentence that ends what the edit says ("shell 12 and shell 40 have no edge in common").
Result<Restructuring> by_hand(const Model& model, const relax::ReferenceSurface& surface, Operation operation,
                              std::span<const ShellIndex> shells, std::span<const NodeIndex> nodes, const Rules& rules,
                              const relax::Judge& judge, const Options& options);

}  // namespace prismesh::mesh::repair

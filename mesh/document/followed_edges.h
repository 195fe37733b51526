// Finds the free edges that follow a shaping edit, so that a view can show them before it is made.
#pragma once

#include <array>
#include <vector>

#include "base/error.h"
#include "mesh/document/edit.h"
#include "mesh/document/generation.h"

namespace prismesh::mesh::document {

/// Returns the free edges that would move by the whole displacement of a shaping edit, by their ends, the lower node first, ascending. The
/// edit's displacement is ignored. Errors: as applying it.
Result<std::vector<std::array<NodeIndex, 2>>> find_followed_edges(const Generation& generation, const Edit& edit);

}  // namespace prismesh::mesh::document

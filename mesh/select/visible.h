// Finds the nodes that a view shows: those that no shell of a visible part hides.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "base/error.h"
#include "mesh/model/model.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::select {

/// Returns those of `candidates` that are in the picture and that no shell hides. `view` maps deck coordinates to clip space (column-major
/// 4x4, perspective or orthographic, nearer points have smaller z/w). What it clips before its near plane hides nothing, and nodes beyond
/// its planes aren't in the picture. `out_of_sight` has an entry for each part, not 0 where the part is hidden; empty: none is hidden.
/// A node isn't hidden by its own shells, nor by shells that lie on it. A quad counts as the two triangles at its diagonal from the first
/// corner to the third. Exact but for rounding, also at silhouettes; the same on every machine.
/// Errors: the view keeps no depth (its matrix can't be inverted where the candidates are).
Result<NodeSet> visible_nodes(const Model& model, const std::array<double, 16>& view, const NodeSet& candidates,
                              std::span<const std::uint8_t> out_of_sight);

}  // namespace prismesh::mesh::select

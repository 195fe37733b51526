// Divides shells in a row, at an edge or about a node, without hanging nodes at the ends. Refusals: as in redivide.h.
#pragma once

#include <optional>

#include "mesh/repair/context.h"
#include "mesh/repair/reshaping.h"
#include "mesh/repair/row.h"

namespace prismesh::mesh::repair {

Refusal divide_row(const RepairContext& context, const Row& row);
/// The shells beyond the ends of a row; nothing: there is no such row.
std::optional<RowEnds> ends_of(const Patch& patch, const Row& row);

/// Divides an edge and the one or two shells at it, each as at the end of a row.
Refusal divide_edge(const RepairContext& context, LocalNode a, LocalNode b, RowEnd first_end, RowEnd second_end);

/// Divides all shells about a node: quads into three, triangles into two.
Refusal divide_about(const RepairContext& context, LocalNode node);

}  // namespace prismesh::mesh::repair

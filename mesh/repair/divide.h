// Divides shells in a row, at an edge or about a node, without hanging nodes at the ends. Refusals as in redivide.h.
#pragma once

#include <optional>

#include "mesh/repair/context.h"
#include "mesh/repair/reshaping.h"
#include "mesh/repair/row.h"

namespace prismesh::mesh::repair {

Refusal divide_row(const RepairContext& context, const Row& row);
/// What is beyond the ends of a row; nothing: there is no such row.
std::optional<RowEnds> ends_of(const Patch& patch, const Row& row);

/// The shells at an edge divided with it, each ended as a row is; a triangle that doesn't absorb becomes two.
Refusal divide_edge(const RepairContext& context, LocalNode a, LocalNode b, RowEnd first_end, RowEnd second_end);

/// All shells about a node, divided between it and what is around: quads into three, triangles into two.
Refusal divide_about(const RepairContext& context, LocalNode node);

}  // namespace prismesh::mesh::repair

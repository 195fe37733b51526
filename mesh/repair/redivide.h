// Divides the area of one shell, or of two with an edge in common, into shells in another way.
// Each operation changes the patch and returns nothing, or returns why that is impossible; then the caller takes the change back.
#pragma once

#include <vector>

#include "mesh/repair/context.h"
#include "mesh/repair/reshaping.h"

namespace prismesh::mesh::repair {

/// A quad into two triangles; `first`: 0 for the diagonal from corner 0 to 2, 1 for that from 1 to 3.
Refusal split_quad(const RepairContext& context, LocalShell quad, int first);

/// The corners of two shells that share exactly one edge, as one loop in the first's sense of rotation; empty: they don't.
Loop loop_of(const Patch& patch, LocalShell first, LocalShell second);
/// Two shells become these (each 3 or 4 of the loop's nodes, in its sense). One shell or two stay, more are new.
Refusal redivide(const RepairContext& context, LocalShell first, LocalShell second, const std::vector<Loop>& pieces);
/// The ways of dividing a loop of 4, 5 or 6 nodes into two or three shells with at most as many triangles as given.
std::vector<std::vector<Loop>> divisions(const Loop& loop, int most_triangles);

}  // namespace prismesh::mesh::repair

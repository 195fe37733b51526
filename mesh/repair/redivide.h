// Divides the area of one shell, or of two with a common edge, into other shells. Each operation changes the patch, or returns why that is
// impossible; then the caller takes the change back.
#pragma once

#include <vector>

#include "mesh/repair/context.h"
#include "mesh/repair/reshaping.h"

namespace prismesh::mesh::repair {

/// Splits a quad into two triangles; `first`: 0 for the diagonal from corner 0 to 2, 1 for that from 1 to 3.
Refusal split_quad(const RepairContext& context, LocalShell quad, int first);

/// The corners of two shells that share exactly one edge, as one loop in the first's sense of rotation; empty if they don't.
Loop loop_of(const Patch& patch, LocalShell first, LocalShell second);
/// Replaces two shells by the pieces: each 3 or 4 of the loop's nodes, in its sense. The first one or two pieces get the shells that are
/// there, the others new ones.
Refusal redivide(const RepairContext& context, LocalShell first, LocalShell second, const std::vector<Loop>& pieces);
/// The ways to divide a loop of 4, 5 or 6 nodes into one to three shells with at most `max_triangles` triangles.
std::vector<std::vector<Loop>> divisions(const Loop& loop, int max_triangles);

}  // namespace prismesh::mesh::repair

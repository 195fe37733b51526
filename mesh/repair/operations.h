// The local operations on a patch. Each either changes the patch and returns nothing, or returns why it can't be done there, as the end of
// a sentence; what it changed until then has to be taken back. Whether the change is worth it is for others to say (appraisal.h).
#pragma once

#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "mesh/repair/appraisal.h"

namespace prismesh::mesh::repair {

using Refusal = std::optional<std::string_view>;
using Loop = std::vector<LocalNode>;

/// A quad into two triangles; `first`: 0 for the diagonal from corner 0 to 2, 1 for that from 1 to 3.
Refusal split_quad(const RepairContext& context, LocalShell quad, int first);

/// The corners of two shells that share exactly one edge, as one loop in the first's sense of rotation; empty: they don't.
Loop loop_of(const Patch& patch, LocalShell first, LocalShell second);
/// Two shells become these (each 3 or 4 of the loop's nodes, in its sense). One shell or two stay, more are new.
Refusal redivide(const RepairContext& context, LocalShell first, LocalShell second, const std::vector<Loop>& pieces);
/// The ways of dividing a loop of 4, 5 or 6 nodes into two or three shells with at most as many triangles as given.
std::vector<std::vector<Loop>> divisions(const Loop& loop, int most_triangles);

/// Each first node becomes the second of its pair, which takes the place given: shells between them go, quads at an end become triangles.
struct Union {
  LocalNode gone;
  LocalNode stays;
};
Refusal unite(const RepairContext& context, const std::vector<Union>& unions);
/// The pair in the order in which it can be united, and null if in none.
std::optional<Union> union_of(const RepairContext& context, LocalNode a, LocalNode b);

/// How a row of divided shells ends in the shell beyond.
enum class RowEnd : std::uint8_t {
  low_triangle,   ///< a quad becomes a triangle, at the corner that its order has first, and a quad
  high_triangle,  ///< the triangle at the other corner
  absorb,         ///< a triangle becomes a quad
  two_triangles,  ///< a triangle becomes two
};
/// A row of quads divided across: through edge `edge` of `start` and the one opposite, `forward` quads beyond the latter and `back` beyond
/// the former.
struct Row {
  LocalShell start;
  int edge = 0;
  int forward = 0;
  int back = 0;
  RowEnd forward_end = RowEnd::low_triangle;
  RowEnd back_end = RowEnd::low_triangle;
};
Refusal divide_row(const RepairContext& context, const Row& row);
/// What is beyond a row's end: the number of corners of the shell there; 0: the sheet ends.
struct RowEnds {
  int forward_corners = 0;
  int back_corners = 0;
};
std::optional<RowEnds> ends_of(const Patch& patch, const Row& row);

/// The shells at an edge divided with it, each ended as a row is; a triangle that doesn't absorb becomes two.
Refusal divide_edge(const RepairContext& context, LocalNode a, LocalNode b, RowEnd first_end, RowEnd second_end);

/// All shells about a node, divided between it and what is around: quads into three, triangles into two.
Refusal divide_about(const RepairContext& context, LocalNode node);

/// Changes nothing, but counts the shells about a shell's corners as changed, so that their nodes settle.
Refusal stir(const RepairContext& context, LocalShell shell);

/// Moves a node along the surface's normal.
Refusal lift_node(const RepairContext& context, LocalNode node, double distance);

}  // namespace prismesh::mesh::repair

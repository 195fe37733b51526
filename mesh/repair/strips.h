// Strips of quads: dividing or removing an edge inside a sheet of quads continues from quad to quad across opposite edges.
#pragma once

#include <compare>
#include <limits>
#include <vector>

#include "mesh/repair/context.h"
#include "mesh/repair/reshaping.h"

namespace prismesh::mesh::repair {

/// Edge `edge` of `start` and all edges that follow from it in both directions, in each sheet at a junction. A strip ends where a sheet
/// ends, in a triangle, or before an edge that is shorter than `min_length`, longer than `max_length` or can't be divided. It may close on
/// itself or turn at a triangle.
struct Strip {
  LocalShell start;
  int edge = 0;
  double min_length = 0;
  double max_length = std::numeric_limits<double>::infinity();
};

/// Divides a strip lengthways into `pieces`. At its end a quad becomes a quad and a triangle (for three pieces: a triangle at each side),
/// and a triangle becomes a quad (`absorbs`) or two triangles. With more pieces it must end at free edges or close on itself.
Refusal divide_strip(const RepairContext& context, const Strip& strip, int pieces = 2, bool absorbs = true);

/// Removes a strip: the two ends of each of its edges become one node. At its end a quad becomes a triangle.
Refusal collapse_strip(const RepairContext& context, const Strip& strip);

/// The path of a strip: the quads that it divides, each with the edge by which it is entered (0 or 1; the opposite edge counts as the
/// same).
struct StripQuad {
  LocalShell shell;
  int edge = 0;
  auto operator<=>(const StripQuad&) const = default;  // NOLINT(modernize-use-nullptr): the check mistakes the operator
};
struct StripPath {
  std::vector<StripQuad> quads;  ///< ascending by shell; empty: there is no such strip
  bool ends_in_triangle = false;
  bool operator==(const StripPath&) const = default;
};
StripPath path_of(const Patch& patch, const Strip& strip);

}  // namespace prismesh::mesh::repair

// Strips: what is divided, or goes, when an edge inside a sheet of quads does, from each quad to the next across its opposite edges.
#pragma once

#include <limits>
#include <vector>

#include "mesh/repair/context.h"
#include "mesh/repair/reshaping.h"

namespace prismesh::mesh::repair {

/// Edge `edge` of `start` and all that follow from it in both directions, in each sheet at a junction. A strip ends where sheets end,
/// closes upon itself, goes around a triangle, or ends before an edge shorter than `least`, longer than `most`, or one that can't be
/// divided.
struct Strip {
  LocalShell start;
  int edge = 0;
  double least = 0;
  double most = std::numeric_limits<double>::infinity();
};

/// Divides a strip lengthways. Where it ends a quad becomes a quad and a triangle (of three pieces: with one at each side), and a triangle
/// a quad (`absorbs`) or two. Of more pieces it has to end by itself.
Refusal divide_strip(const RepairContext& context, const Strip& strip, int pieces = 2, bool absorbs = true);

/// Takes a strip out: the two ends of each of its edges become one node. Where it ends a quad becomes a triangle.
Refusal collapse_strip(const RepairContext& context, const Strip& strip);

/// What a strip goes over: the quads that it divides, each with the edge by which it is entered (0 or 1, the one opposite is the same).
struct StripQuad {
  LocalShell shell;
  int edge = 0;
  bool operator==(const StripQuad&) const = default;
};
struct StripCourse {
  std::vector<StripQuad> quads;  ///< ascending by shell; empty: there is no such strip
  bool ends_in_triangle = false;
  bool operator==(const StripCourse&) const = default;
};
StripCourse course_of(const Patch& patch, const Strip& strip);

}  // namespace prismesh::mesh::repair

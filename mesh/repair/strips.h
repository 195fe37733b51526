// Strips: what is divided when an edge inside a sheet of quads is, from each quad to the next across its opposite edges.
#pragma once

#include <vector>

#include "mesh/repair/operations.h"

namespace prismesh::mesh::repair {

/// A strip to divide lengthways into several: edge `edge` of `start` and all that follow from it in both directions, in each sheet at a
/// junction. It ends where sheets end, closes upon itself, goes around a triangle, or ends before an edge shorter than `least`, or one that
/// can't be divided: there a quad becomes a quad and a triangle (of three pieces: with one at each side), and a triangle a quad (`absorbs`)
/// or two. Of more pieces it has to end by itself.
struct Strip {
  LocalShell start;
  int edge = 0;
  int pieces = 2;
  double least = 0;
  bool absorbs = true;
};
Refusal divide_strip(const Site& site, const Strip& strip);

/// The quads that such a strip divides, each with the edge by which it is entered (0 or 1, the one opposite is the same); empty: it can't
/// be.
struct StripQuad {
  LocalShell shell;
  int edge = 0;
};
std::vector<StripQuad> quads_of(const Patch& patch, const Strip& strip);

}  // namespace prismesh::mesh::repair

// A row of quads to be divided, and how it ends.
#pragma once

#include <cstdint>

#include "mesh/repair/patch.h"

namespace prismesh::mesh::repair {

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
/// What is beyond a row's end: the number of corners of the shell there; 0: the sheet ends.
struct RowEnds {
  int forward_corners = 0;
  int back_corners = 0;
};

}  // namespace prismesh::mesh::repair

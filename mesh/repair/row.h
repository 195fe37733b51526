// A row of quads to divide, and how it ends.
#pragma once

#include <cstdint>

#include "mesh/repair/patch.h"

namespace prismesh::mesh::repair {

/// How a row of divided shells ends in the shell beyond.
enum class RowEnd : std::uint8_t {
  low_triangle,   ///< a quad becomes a quad and a triangle, at the corner that comes first in its order
  high_triangle,  ///< the same with the triangle at the other corner
  absorb,         ///< a triangle becomes a quad
  two_triangles,  ///< a triangle becomes two
};
/// A row of quads to divide through edge `edge` of `start` and the opposite edge, with `forward` more quads after the opposite edge and
/// `back` more before `edge`.
struct Row {
  LocalShell start;
  int edge = 0;
  int forward = 0;
  int back = 0;
  RowEnd forward_end = RowEnd::low_triangle;
  RowEnd back_end = RowEnd::low_triangle;
};
/// Number of corners of the shell beyond each end of a row; 0: the sheet ends.
struct RowEnds {
  int forward_corners = 0;
  int back_corners = 0;
};

}  // namespace prismesh::mesh::repair

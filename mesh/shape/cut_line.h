// A line across a patch of surface. Private to mesh/shape.
#pragma once

#include <cstdint>
#include <vector>

namespace prismesh::mesh::shape {

/// The line where `height` is 0, or those pieces of it that count. Nodes and shells are local to a patch.
struct CutLine {
  std::vector<double> height;        ///< of each node, deck's length unit; NaN where unknown. Greater than 0 on one side
  double tolerance = 0;              ///< a node up to this height is on the line
  std::vector<std::uint8_t> shells;  ///< 1: the line touches this shell and counts there

  bool before(std::uint32_t node) const { return height[node] < -tolerance; }
  bool beyond(std::uint32_t node) const { return height[node] > tolerance; }
  bool on_line(std::uint32_t node) const { return !before(node) && !beyond(node); }
};

}  // namespace prismesh::mesh::shape

// Feature lines as relaxing sees them: free edges, creases, junctions and borders between parts. Private to mesh/relax.
#pragma once

#include <array>
#include <cstddef>

#include "mesh/model/adjacency.h"
#include "mesh/model/model.h"

namespace prismesh::mesh::relax {

/// Around a shell's corners.
inline int next_corner(int corner, int corners) { return corner + 1 < corners ? corner + 1 : 0; }
inline int previous_corner(int corner, int corners) { return corner > 0 ? corner - 1 : corners - 1; }

bool has_edge(const ShellNodes& shell, NodeIndex a, NodeIndex b);

/// The other shell at the edge between two corners of `shell`, where exactly one is there and the two make no crease: where one sheet goes
/// on smoothly. Invalid otherwise.
ShellIndex across(const Model& model, ShellIndex shell, NodeIndex a, NodeIndex b, double cos_limit);

/// Where feature lines go from a node.
struct LineEnds {
  static constexpr std::size_t kMax = 3;  ///< more than two make a corner, however many
  std::array<NodeIndex, kMax> other;      ///< ends of the feature edges at the node, ascending
  std::size_t count = 0;
};
/// With `part_borders` an edge between shells of different parts counts as well.
LineEnds line_ends(const Model& model, NodeIndex node, double cos_limit, bool part_borders);

/// Whether a line goes through the node: two feature edges that bend by no more than the angle.
bool passes_through(const Model& model, NodeIndex node, const LineEnds& ends, double cos_limit);

}  // namespace prismesh::mesh::relax

// Feature lines of a mesh: free edges, creases, junctions and borders between parts. Private to mesh/relax.
#pragma once

#include <array>
#include <cstddef>

#include "mesh/model/adjacency.h"
#include "mesh/model/model.h"

namespace prismesh::mesh::relax {

/// The next and the previous corner around a shell.
inline int next_corner(int corner, int corners) { return corner + 1 < corners ? corner + 1 : 0; }
inline int previous_corner(int corner, int corners) { return corner > 0 ? corner - 1 : corners - 1; }

bool has_edge(const ShellNodes& shell, NodeIndex a, NodeIndex b);

/// The other shell at the edge between two corners of `shell`, if there is exactly one and the edge is no crease; invalid otherwise.
/// `cos_limit`: cosine of the feature angle.
ShellIndex smooth_neighbour(const Model& model, ShellIndex shell, NodeIndex a, NodeIndex b, double cos_limit);

/// The feature edges at a node.
struct LineEnds {
  static constexpr std::size_t kMax = 3;  ///< more aren't kept: three already make the node a corner
  std::array<NodeIndex, kMax> other;      ///< the other ends, ascending
  std::size_t count = 0;
};
/// With `part_borders` an edge between shells of different parts is a feature edge as well.
LineEnds line_ends(const Model& model, NodeIndex node, double cos_limit, bool part_borders);

/// Whether a feature line passes through the node: it has two feature edges, which turn by no more than the angle.
bool passes_through(const Model& model, NodeIndex node, const LineEnds& ends, double cos_limit);

}  // namespace prismesh::mesh::relax

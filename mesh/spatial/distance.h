// Computes the shortest distance between two sets of nodes and shells.
#pragma once

#include <array>
#include <optional>

#include "mesh/model/model.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::spatial {

/// Points and surfaces; either may be empty.
struct Shape {
  NodeSet nodes;
  ShellSet shells;
};

struct Closest {
  double distance = 0;  ///< deck's length unit; 0 where surfaces touch or cross
  struct End {
    Vec3 point = Vec3::Zero();
    NodeIndex node;    ///< the node or
    ShellIndex shell;  ///< the shell it lies on; the other is invalid
  };
  End a;
  End b;
};

/// Returns the shortest distance and its end points; absent if a shape is empty. Exact for nodes and shells; a quad counts as the two
/// triangles at its diagonal from the first corner to the third. Method: a simultaneous traversal of two bounding volume hierarchies
/// [Larsen 1999], "Fast proximity queries with swept sphere volumes", here with boxes.
std::optional<Closest> shortest_distance(const Model& model, const Shape& a, const Shape& b);

/// Corners; segments and points count as triangles too.
using Triangle = std::array<Vec3, 3>;

/// The nearest points of two triangles, and the square of their distance.
struct Nearest {
  double distance2 = 0;
  Vec3 on_a = Vec3::Zero();
  Vec3 on_b = Vec3::Zero();
};
Nearest nearest_of_triangles(const Triangle& a, const Triangle& b);

}  // namespace prismesh::mesh::spatial

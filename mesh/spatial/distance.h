// The shortest way between two sets of nodes and shells.
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

/// Exact over nodes and shells, a quad taken as the two triangles at its diagonal from the first corner to the third. Absent
/// if a shape is empty. Two bounding volume trees walked together: Larsen et al., "Fast proximity queries with swept sphere
/// volumes", 1999, with boxes for volumes.
std::optional<Closest> shortest_distance(const Model& model, const Shape& a, const Shape& b);

/// Corners; segments and points count as triangles too.
using Triangle = std::array<Vec3, 3>;

/// The nearest points of two triangles.
struct Nearest {
  double distance2 = 0;
  Vec3 on_a = Vec3::Zero();
  Vec3 on_b = Vec3::Zero();
};
Nearest nearest_of_triangles(const Triangle& a, const Triangle& b);

}  // namespace prismesh::mesh::spatial

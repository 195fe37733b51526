// Normals of the shells of a patch.
#pragma once

#include <Eigen/Geometry>

#include "mesh/repair/patch.h"

namespace prismesh::mesh::repair {

/// A shell's normal with twice its area as length; `at(node)` is a corner's position.
template <class PositionOf>
Vec3 area_normal_of(const Corners& corners, const PositionOf& at) {
  const bool is_triangle = corner_count(corners) == 3;
  const Vec3 across = at(corners[is_triangle ? 1 : 2]) - at(corners[0]);
  return across.cross(is_triangle ? Vec3(at(corners[2]) - at(corners[0])) : Vec3(at(corners[3]) - at(corners[1])));
}

/// The same where the corners are now.
inline Vec3 area_normal(const Patch& patch, const Corners& corners) {
  return area_normal_of(corners, [&](LocalNode n) -> const Vec3& { return patch.position(n); });
}

}  // namespace prismesh::mesh::repair

// The area of shells.
#pragma once

#include <algorithm>

#include <Eigen/Geometry>

#include "mesh/contact/shell_triangles.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::contact {

inline double area_of(const Model& model, ShellIndex shell) {
  double area = 0;
  each_shell_triangle(model, shell, [&](const ShellTriangle& t) { area += (t.at[1] - t.at[0]).cross(t.at[2] - t.at[0]).norm() / 2; });
  return area;
}

inline double area_of(const Model& model, const ShellSet& shells) {
  double area = 0;
  for (const ShellIndex shell : shells) area += area_of(model, shell);
  return area;
}

/// The area of the side of a region that has less.
inline double area_of_smaller(const Model& model, const ShellSet& shells_a, const ShellSet& shells_b) {
  return std::min(area_of(model, shells_a), area_of(model, shells_b));
}

}  // namespace prismesh::mesh::contact

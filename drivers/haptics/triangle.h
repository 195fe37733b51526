// The nearest point of a triangle.
#pragma once

#include <Eigen/Core>

namespace prismesh::drivers::haptics {

/// Returns the point of the triangle a b c that is nearest to p, also for triangles without area [Ericson 2005].
Eigen::Vector3d nearest_of_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);

}  // namespace prismesh::drivers::haptics

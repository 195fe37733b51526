// Unfolds the mesh in front of obtuse corners, for fast marching.
#pragma once

#include <cstdint>

#include "mesh/spatial/patch.h"

namespace prismesh::mesh::spatial {

/// Returns the angle between a local shell's two sides at one of its local nodes, in radians; 0 for a line.
double corner_angle(const Patch& patch, std::uint32_t shell, std::uint32_t node);

/// Fills `patch.unfolded` and its CSR. At an obtuse corner a front may arrive before the distances beyond the opposite side are known. So
/// the shells beyond this side are unfolded into the corner's plane until a node lies in front of the corner: this node and the corner's
/// sides make two triangles that aren't obtuse [Kimmel 1998]: "Computing geodesic paths on manifolds".
void unfold_obtuse_corners(Patch& patch);

}  // namespace prismesh::mesh::spatial

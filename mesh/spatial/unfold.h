// What lies in front of an obtuse corner, laid flat.
#pragma once

#include <cstdint>

#include "mesh/spatial/patch.h"

namespace prismesh::mesh::spatial {

/// Angle in radians between a local shell's two sides at one of its local nodes; 0 for a line.
double corner_angle(const Patch& patch, std::uint32_t shell, std::uint32_t node);

/// Fills `patch.unfolded` and its CSR. An obtuse corner may be passed by a front whose support beyond the opposite side comes
/// later; laying the shells beyond that side flat until a node lies in front of the corner gives two triangles that aren't
/// obtuse (Kimmel & Sethian, "Computing geodesic paths on manifolds", 1998).
void unfold_obtuse_corners(Patch& patch);

}  // namespace prismesh::mesh::spatial

// Lists the triangles near a brick that have moved between two generations, for a pen that touches a shell while it moves.
#pragma once

#include <cstdint>

#include "base/haptic_field.h"
#include "mesh/field/placement.h"
#include "mesh/spatial/box_tree.h"

namespace prismesh::mesh::field {

/// Fills the part of the field about moved triangles: those that at any time of their straight motion may come within two spacings of the
/// fine brick, ascending by element, and the buckets that name them. Sets `before_generation` to the given one; to 0, with no triangle, if
/// shells near the coarse brick were added, removed or got other corners, if a triangle there has become finite or has ceased to be, if
/// more than kMaxMovedTriangles moved or their entries exceed kMaxBucketEntries. Then the reader lets go.
/// Returns the shells within `near_mm` of the coarse brick that moved, and those that do at any time of their motion; empty with a
/// `before_generation` of 0. Preconditions: both bricks are placed; both trees are of one model; `before_generation` isn't 0.
ShellSet fill_moved(const spatial::BoxTree& before, const spatial::BoxTree& now, const Placement& placement,
                    std::uint64_t before_generation, double near_mm, HapticField& field);
/// The same without an earlier generation: the reader lets go.
void fill_unknown_motion(HapticField& field);

}  // namespace prismesh::mesh::field

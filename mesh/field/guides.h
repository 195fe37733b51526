// Finds what pulls the haptic pen gently: nodes and feature lines near it.
#pragma once

#include "base/haptic_field.h"
#include "mesh/field/placement.h"
#include "mesh/model/model.h"
#include "mesh/spatial/box_tree.h"

namespace prismesh::mesh::field {

/// How far from the pen guides are looked for: the pull's reach (drivers/haptics/forces.h), and half as much again for the pen's way until
/// the next guides.
inline constexpr double kGuideReachMm = 6;
/// Nodes guide only where a shell's shortest edge is this long for the hand: the pulls of a finer mesh would only be felt as roughness.
inline constexpr double kNodeGuideEdgeMm = 4;
/// Edges of shells whose planes differ by more are feature lines, and so are free edges and junctions.
inline constexpr double kGuideCreaseDegrees = 30;

/// Fills `count` and `guides` with the nearest kMaxGuides of the nodes and feature edges within kGuideReachMm of the pen, nearest first; of
/// equally near ones nodes first, then by index. Where more than 2,000 shells are that near, a half or a quarter of the reach counts; where
/// they still are, there are no guides. Places are those of the tree; shells that it leaves out don't guide. Preconditions: the model has
/// its adjacency, and the tree's shells are shells of the model; the pen's place is finite.
void find_guides(const Model& model, const spatial::BoxTree& tree, const Placement& placement, const Vec3& pen_mm, HapticGuides& guides);

}  // namespace prismesh::mesh::field

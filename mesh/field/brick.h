// Fills bricks of unsigned distances from the nearest shell, for the haptic pen. Method and figures: docs/distance-field.md.
#pragma once

#include <optional>

#include <Eigen/Geometry>

#include "base/haptic_field.h"
#include "mesh/field/placement.h"
#include "mesh/model/model.h"
#include "mesh/spatial/box_tree.h"

namespace prismesh::mesh::field {

/// Nodes of all bricks of one spacing lie on one lattice about the origin of the pen's space. A brick begins at every fourth of them, so
/// that the brick of a pen that has moved shares blocks of 4 x 4 x 4 nodes with the one before.
inline constexpr int kBlockSide = 4;

struct BrickShape {
  double spacing_mm = 1;  ///< 0.01 to 10
  int count = 32;         ///< nodes in each direction: a multiple of 4, at most kMaxBrickSide
  double reach_mm = 4.5;  ///< farther nodes get this distance and no element; above 0
};

/// The fine brick holds what is within 10 mm of the pen, the coarse one where the pen can be in 20 ms at 1.5 m/s beyond that.
BrickShape fine_shape();
BrickShape coarse_shape();

/// A brick that was filled before, of the same shape and placement, and what has changed since.
struct EarlierBrick {
  const HapticBrick* brick = nullptr;
  /// Contains, in the model, each shell that has changed since, as it was and as it is; empty: none has.
  spatial::FloatBox changed;
};

/// Fills a brick about the pen with the exact distances, in the pen's space, of its nodes from the shells of the tree, and the nearest
/// shells; of equally near ones, the first. Distances have the error of a few roundings of the reach in single precision. The bits are the
/// same whatever the number of threads, however the tree came about, and with or without an earlier brick, whose blocks are taken over
/// where no change is near. Nodes beyond the count aren't touched. Precondition: the numbers are finite; `earlier` isn't `brick`.
void fill_brick(const spatial::BoxTree& tree, const Placement& placement, const BrickShape& shape, const Vec3& pen_mm, HapticBrick& brick,
                const EarlierBrick& earlier = {});

/// Fills the fine and the coarse brick at once, on all cores.
void fill_bricks(const spatial::BoxTree& tree, const Placement& placement, const Vec3& pen_mm, HapticBrick& fine, HapticBrick& coarse,
                 const EarlierBrick& earlier_fine = {}, const EarlierBrick& earlier_coarse = {});

}  // namespace prismesh::mesh::field

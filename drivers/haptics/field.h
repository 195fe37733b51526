// Reads the distance field around the pen (base/haptic_field.h): distances with proved bounds, and the way of moved shells.
//
// A true distance changes by no more than the way between two points. The trilinear mean of exact distances at the eight nodes around a
// point is therefore wrong by at most the mean way to these nodes, at most spacing * sqrt(u (1 - u) + v (1 - v) + w (1 - w)), where u, v, w
// are the shares between the nodes: 0.87 spacings in the middle of a cell.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "base/haptic_field.h"

namespace prismesh::drivers::haptics {

/// Whether the header's numbers can be used: counts, spacing, origins, bounds of indices. Takes no look at the distances. Constant time.
bool usable(const HapticField& field);

struct FieldSample {
  bool known = false;                                  ///< false: outside of the bricks, or a distance isn't a number
  double distance_mm = 0;                              ///< trilinear
  double proved_mm = 0;                                ///< no shell is nearer than this; may be negative
  double spacing_mm = 0;                               ///< of the brick that was read
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  ///< of the trilinear distance
  std::int32_t element = -1;                           ///< nearest element of the nearest node
};
/// Reads the fine brick where it covers the place, else the coarse one. `field` must be usable.
FieldSample sample(const HapticField& field, const Eigen::Vector3d& at_mm);

/// Returns a proved bound of the distance to the shells that haven't moved since the generation before; negative where there is none.
double proved_still_mm(const HapticField& field, const Eigen::Vector3d& at_mm);

/// The nearest point of the moved triangles at a time of their motion.
struct MovedNearest {
  bool known = false;                                  ///< false: outside of the fine brick, or too many triangles in its bucket
  double distance_mm = 0;                              ///< the reach where no triangle is nearer
  Eigen::Vector3d point_mm = Eigen::Vector3d::Zero();  ///< only where distance_mm is less than the reach
};
/// `part` of the motion, 0 to 1. Reads at most kMaxTrianglesRead triangles.
inline constexpr std::uint32_t kMaxTrianglesRead = 128;
MovedNearest nearest_moved(const HapticField& field, const Eigen::Vector3d& at_mm, double part);

}  // namespace prismesh::drivers::haptics

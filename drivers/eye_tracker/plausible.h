// Where a viewer's head can be. Trackers drop what lies outside: a corrupted byte, a reflection, somebody passing by at the side.
#pragma once

#include <cmath>

#include <Eigen/Core>

namespace prismesh::drivers::eye_tracker {

inline constexpr double kFarthestAsideMm = 1400;  ///< left, right, up or down from the screen's centre
inline constexpr double kNearestMm = 100;
inline constexpr double kFarthestMm = 4000;

/// `between_eyes_mm` in screen coordinates. Not-a-number is nowhere.
inline bool plausible_head(const Eigen::Vector3d& between_eyes_mm) {
  return std::abs(between_eyes_mm.x()) <= kFarthestAsideMm && std::abs(between_eyes_mm.y()) <= kFarthestAsideMm &&
         between_eyes_mm.z() >= kNearestMm && between_eyes_mm.z() <= kFarthestMm;
}

}  // namespace prismesh::drivers::eye_tracker

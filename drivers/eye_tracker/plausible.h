// The range of possible head positions. Trackers reject positions outside: a corrupted byte, a reflection, a person passing by.
#pragma once

#include <cmath>

#include <Eigen/Core>

namespace prismesh::drivers::eye_tracker {

inline constexpr double kMaxLateralMm = 1400;  ///< to each side, and up or down, from the screen's centre
inline constexpr double kMinDistanceMm = 100;
inline constexpr double kMaxDistanceMm = 4000;

/// `between_eyes_mm` in screen coordinates. Returns false for NaN.
inline bool plausible_head(const Eigen::Vector3d& between_eyes_mm) {
  return std::abs(between_eyes_mm.x()) <= kMaxLateralMm && std::abs(between_eyes_mm.y()) <= kMaxLateralMm &&
         between_eyes_mm.z() >= kMinDistanceMm && between_eyes_mm.z() <= kMaxDistanceMm;
}

}  // namespace prismesh::drivers::eye_tracker

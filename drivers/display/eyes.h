// Positions of the two eyes before the screen, in millimetres. The origin is the screen's centre; x to the right, y up, z toward the
// viewer.
#pragma once

#include <cstdint>

#include <Eigen/Core>

namespace prismesh::drivers::display {

enum class Eye : unsigned char { left, right };

struct EyePair {
  Eigen::Vector3d left;
  Eigen::Vector3d right;
  const Eigen::Vector3d& of(Eye eye) const { return eye == Eye::left ? left : right; }
};

inline constexpr double kMeanEyeSeparationMm = 63;

/// Returns the eyes for the point between them. `toward_right`: unit vector from the left eye to the right one.
inline EyePair eyes_from(const Eigen::Vector3d& between_mm, double separation_mm,
                         const Eigen::Vector3d& toward_right = Eigen::Vector3d::UnitX()) {
  const Eigen::Vector3d half = 0.5 * separation_mm * toward_right;
  return {between_mm - half, between_mm + half};
}

}  // namespace prismesh::drivers::display

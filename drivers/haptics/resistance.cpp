#include "drivers/haptics/resistance.h"

#include <algorithm>
#include <cmath>

namespace prismesh::drivers::haptics {

double resisting_newton(const HapticResistance* slot, double max_newton) {
  if (slot == nullptr || !(slot->newton > 0)) return 0;
  const double length = Eigen::Map<const Eigen::Vector3d>(slot->direction).norm();
  return length > 0.5 && length < 2 ? std::min(slot->newton, max_newton) : 0;
}

Eigen::Vector3d Resistance::step(const Eigen::Vector3d& pen_mm, const HapticResistance* slot, double max_newton, double full_stretch_mm) {
  const double newton = resisting_newton(slot, max_newton);
  if (!(newton > 0) || !(full_stretch_mm > 0) || !pen_mm.allFinite()) {
    let_go();
    return Eigen::Vector3d::Zero();
  }
  const Eigen::Vector3d direction = Eigen::Map<const Eigen::Vector3d>(slot->direction).normalized();
  if (!has_last_) {
    stretch_mm_ = 0;
  } else {
    // Of a spring that lies otherwise, what lies in the new direction is left.
    stretch_mm_ *= std::max(0.0, direction.dot(direction_));
    stretch_mm_ = std::clamp(stretch_mm_ + (pen_mm - last_mm_).dot(direction), 0.0, full_stretch_mm);
  }
  has_last_ = true;
  last_mm_ = pen_mm;
  direction_ = direction;
  return -newton * stretch_mm_ / full_stretch_mm * direction;
}

}  // namespace prismesh::drivers::haptics

// The resistance of what gets worse while it is dragged: a spring that is drawn along.
#pragma once

#include <Eigen/Core>

#include "base/haptic_field.h"

namespace prismesh::drivers::haptics {

/// How far the pen moves in the direction in which the elements get worse until the resistance is full.
inline constexpr double kFullStretchMm = 6;

/// A spring from the pen to a point that follows it: on the way in the bad direction the spring is stretched up to a full stretch, then
/// drawn along; on the way back it gets shorter, then follows without a force. So the force depends on where the pen was, not on its speed,
/// of which a trembling hand and a coarse position give no usable figure. Like friction with an elastic contact [Dahl 1968] [Hayward 2000],
/// but in one direction only. It gives back no more than half of force times stretch: 6 mJ.
class Resistance {
 public:
  /// Returns the force at a place of the pen. `slot`: of the pen's placement; null: nothing resists. `max_newton`: of the force.
  Eigen::Vector3d step(const Eigen::Vector3d& pen_mm, const HapticResistance* slot, double max_newton, double full_stretch_mm);
  void let_go() { has_last_ = false; }

 private:
  bool has_last_ = false;
  Eigen::Vector3d last_mm_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction_ = Eigen::Vector3d::Zero();
  double stretch_mm_ = 0;
};

/// What of a slot's force counts: 0 where it has no direction or isn't above 0.
double resisting_newton(const HapticResistance* slot, double max_newton);

}  // namespace prismesh::drivers::haptics

// Simulates head motions for simulated trackers, tests and benchmarks: smooth, repeatable for a seed, and exactly known at any time.
#pragma once

#include <cstdint>
#include <string_view>

#include <Eigen/Core>
#include "base/error.h"

namespace prismesh::drivers::eye_tracker {

enum class MotionKind : std::uint8_t {
  still,  ///< sitting: tremor of a fraction of a millimetre
  sway,   ///< standing: slow, some centimetres
  lean,   ///< toward the screen and back
  turn,   ///< fast steps to the side, up to about 412 mm/s
  tour,   ///< all of these one after the other, for demonstrations
};
Result<MotionKind> motion_kind_from(std::string_view name);

class HeadMotion {
 public:
  /// `middle_mm`: the centre of the motion. `speed`: factor on time.
  HeadMotion(MotionKind kind, std::uint64_t seed, const Eigen::Vector3d& middle_mm = {0, 0, 650}, double speed = 1);
  /// Returns the true point between the eyes at a time since the start. Calls may come in any order.
  Eigen::Vector3d between_eyes_mm(double seconds) const;
  Eigen::Vector3d velocity_mm_s(double seconds) const;

 private:
  MotionKind kind_;
  std::uint64_t seed_;
  Eigen::Vector3d middle_mm_;
  double speed_;
};

}  // namespace prismesh::drivers::eye_tracker

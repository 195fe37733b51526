// All thresholds of the haptic loop, with units. Starting values: none was tried on a device.
#pragma once

#include <cstdint>

namespace prismesh::drivers::haptics {

struct HapticLimits {
  // Force.
  double max_newton = 8;                  ///< max. length of the force; the device's own limit if that is less
  double max_rise_newton_s = 200;         ///< max. speed of rises; falls are free
  double start_newton = 0.4;              ///< max. length at the moment of arming
  std::int64_t start_ns = 1'000'000'000;  ///< from there to max_newton
  // Energy: work put into the hand beyond what the hand put in.
  double burst_joule = 0.020;       ///< at once
  double steady_watt = 0.050;       ///< on average
  double max_credit_joule = 0.064;  ///< of the hand's work, so much may be given back: 8 N at 500 N/m
  // Time.
  std::int64_t period_ns = 1'000'000;       ///< of the loop
  std::int64_t late_ns = 2'000'000;         ///< a tick so much after its due time: damping only. A command holds for a period and this
  std::int64_t latch_late_ns = 10'000'000;  ///< so much: latch
  std::int64_t pose_old_ns = 4'000'000;     ///< no pose newer than this: damping only
  std::int64_t pose_lost_ns = 10'000'000;   ///< no pose newer than this: latch
  std::int64_t field_old_ns = 100'000'000;  ///< parts from older data fade
  std::int64_t fade_ns = 50'000'000;        ///< to zero within this
  std::int64_t ahead_ns = 1'000'000;        ///< data from further in the future counts as missing
  // Motion.
  double max_speed_mm_s = 1500;              ///< over this: latch
  std::int64_t speed_window_ns = 4'000'000;  ///< speed is measured over at least this
  double jump_mm = 1;                        ///< two poses further apart than this and max_speed_mm_s times their time: latch
};

}  // namespace prismesh::drivers::haptics

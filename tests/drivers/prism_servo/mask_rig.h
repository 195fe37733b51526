// Head, mask control, driver, cable, servo and mask in virtual time, in the device loop's order.
#pragma once

#include <cmath>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>

#include "drivers/prism_servo/mask_control.h"
#include "tests/drivers/prism_servo/servo_rig.h"

namespace prismesh::drivers::prism_servo {

using dynamixel::kMs;
using dynamixel::kTickNs;

struct MaskRigSettings {
  dynamixel::RigSettings servo;
  display::MaskOptics optics;
  MaskLimits limits;
  std::int64_t measure_every_ns = 16'666'667;  ///< a 60 Hz tracker
  std::int64_t tracker_latency_ns = 20 * kMs;
};

class MaskRig {
 public:
  explicit MaskRig(const MaskRigSettings& settings = {})
      : settings_(settings), servo_(with_baud(settings.servo)), control_(settings.optics, settings.limits) {}

  /// The head's position at a time; replaced by tests.
  std::function<Eigen::Vector3d(double seconds)> head = [](double) { return Eigen::Vector3d(0, 0, 650); };
  bool eyes = true;
  bool picture_mono = false;
  bool rearm = false;  ///< for one tick
  std::optional<double> hold_mm;

  const MaskControl::Output& tick() {
    const std::int64_t now = servo_.clock().now_ns();
    if (eyes && now >= next_measurement_ns_) measure(now);
    MaskControl::Input input;
    servo_.goal_mm = output_.goal_mm;
    servo_.powered = output_.powered;
    input.servo = servo_.tick();
    // The rig's tick ends with the advance of time; the readings belong to its start.
    input.now_ns = now;
    input.head = head_state_;
    input.head_seen = eyes;
    input.servo_lag_ns = servo_.driver().lag_ns() + kTickNs;
    input.picture_mono = picture_mono;
    input.hold_mm = hold_mm ? &*hold_mm : nullptr;
    input.rearm = std::exchange(rearm, false);
    output_ = control_.step(input);
    if (each_tick) each_tick(input, output_);
    return output_;
  }
  void run_for(std::int64_t ns) {
    for (const std::int64_t end = servo_.clock().now_ns() + ns; servo_.clock().now_ns() < end;) tick();
  }
  /// Milliseconds until the given phase, or -1.
  std::int64_t run_until(MaskPhase phase, std::int64_t max_ms = 10'000) {
    const std::int64_t start = servo_.clock().now_ns();
    for (std::int64_t ms = 0; ms <= max_ms; ms = (servo_.clock().now_ns() - start) / kMs) {
      if (output_.state.phase == phase) return ms;
      tick();
    }
    return -1;
  }
  /// Milliseconds until stereo may be shown, or -1.
  std::int64_t run_until_stereo(std::int64_t max_ms = 10'000) {
    const std::int64_t start = servo_.clock().now_ns();
    for (std::int64_t ms = 0; ms <= max_ms; ms = (servo_.clock().now_ns() - start) / kMs) {
      if (output_.state.stereo_allowed) return ms;
      tick();
    }
    return -1;
  }

  std::function<void(const MaskControl::Input&, const MaskControl::Output&)> each_tick;

  double seconds() { return static_cast<double>(servo_.clock().now_ns()) * 1e-9; }
  dynamixel::ServoRig& servo() { return servo_; }
  dynamixel::SimulatedServo& mask() { return servo_.simulated(); }
  MaskControl& control() { return control_; }
  const MaskState& state() const { return output_.state; }
  const MaskControl::Output& output() const { return output_; }
  double half_period_mm() const { return settings_.optics.mask_pitch_mm() / 2; }
  /// The ideal position of the mask now.
  double ideal_mm() { return display::mask_position_mm(settings_.optics, head(seconds())) - output_.state.half_periods * half_period_mm(); }

 private:
  static dynamixel::RigSettings with_baud(dynamixel::RigSettings settings) {
    settings.simulated.baud = 1'000'000;
    return settings;
  }
  void measure(std::int64_t now) {
    next_measurement_ns_ = now + settings_.measure_every_ns;
    head_state_.time_ns = now - settings_.tracker_latency_ns;
    const double then = static_cast<double>(head_state_.time_ns) * 1e-9;
    head_state_.between_eyes_mm = head(then);
    head_state_.velocity_mm_s = (head(then + 0.001) - head(then - 0.001)) / 0.002;
  }

  MaskRigSettings settings_;
  dynamixel::ServoRig servo_;
  MaskControl control_;
  MaskControl::Output output_;
  eye_tracker::HeadState head_state_;
  std::int64_t next_measurement_ns_ = 0;
};

}  // namespace prismesh::drivers::prism_servo

// A simulated pen: a mass with damping, friction and a coarse position, held by a hand, behind a line with delay and jitter. In virtual
// time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>

#include <Eigen/Core>

#include "drivers/haptic_pen/pen.h"

namespace prismesh::drivers::haptic_pen {

/// What the hand does at a time: it holds the pen by a spring and a damper, and pushes.
struct SimulatedHand {
  Eigen::Vector3d goal_mm = Eigen::Vector3d::Zero();
  double stiffness_newton_m = 300;  ///< 0 and no damping: it lets go
  double damping_newton_s_m = 3;
  Eigen::Vector3d push_newton = Eigen::Vector3d::Zero();
  std::uint32_t buttons = 0;  ///< that it presses, a bit each
};
/// Returns the hand at a time in seconds since the start. Must not allocate if ticks must not.
using HandSource = std::function<SimulatedHand(double seconds)>;

struct SimulatedPenOptions {
  double mass_kg = 0.12;
  double damping_newton_s_m = 1.0;
  double friction_newton = 0.05;
  double quantum_mm = 0.02;
  double max_newton = 8;
  double workspace_mm = 60;               ///< stops at so much to each side
  std::int64_t pose_delay_ns = 300'000;   ///< from the motion to the answer
  std::int64_t force_delay_ns = 300'000;  ///< from `send` to the motors
  std::int64_t jitter_ns = 0;             ///< random, added to the delay of poses
  std::int64_t period_ns = 1'000'000;     ///< of the loop that calls it: answers wait for the next tick
  std::uint64_t seed = 1;
};

class SimulatedPen final : public HapticPen {
 public:
  SimulatedPen(const SimulatedPenOptions& options, HandSource hand);

  PenReading read(std::int64_t now_ns) override;
  void send(std::int64_t now_ns, const PenCommand& command) override;
  const PenLimits& limits() const override { return limits_; }
  bool gone() const override { return unplugged_; }

  // Faults: each holds until it is taken back.
  void unplug(bool unplugged) { unplugged_ = unplugged; }
  void lose_next_replies(std::uint32_t count) { replies_to_lose_ = count; }

  /// The true motion, which the loop doesn't see.
  const Eigen::Vector3d& position_mm() const { return position_mm_; }
  const Eigen::Vector3d& velocity_mm_s() const { return velocity_mm_s_; }
  std::uint32_t buttons() const { return buttons_; }
  const Eigen::Vector3d& applied_newton() const { return applied_.newton; }
  /// Work of the motors on the pen since the start.
  double motor_joule() const { return motor_joule_; }
  double kinetic_joule() const { return 0.5 * options_.mass_kg * velocity_mm_s_.squaredNorm() * 1e-6; }

 private:
  struct Sent {
    std::int64_t at_ns = 0;
    PenCommand command;
  };
  struct Answer {
    std::int64_t at_ns = 0;
    PenPose pose;
  };
  void run_until(std::int64_t now_ns);
  void move(std::int64_t step_ns);
  std::int64_t jitter_ns();

  SimulatedPenOptions options_;
  HandSource hand_;
  PenLimits limits_;
  std::int64_t start_ns_ = 0, now_ns_ = 0;
  bool started_ = false, unplugged_ = false;
  std::uint32_t replies_to_lose_ = 0, lost_ = 0;
  std::uint64_t random_;
  Eigen::Vector3d position_mm_ = Eigen::Vector3d::Zero(), velocity_mm_s_ = Eigen::Vector3d::Zero();
  PenCommand applied_;
  std::uint32_t buttons_ = 0;
  double motor_joule_ = 0;
  std::array<Sent, 32> sent_{};       ///< on the way to the motors
  std::array<Answer, 32> answers_{};  ///< on the way to the host; answers_[i].at_ns rises
  std::size_t sent_count_ = 0, answer_count_ = 0;
};

}  // namespace prismesh::drivers::haptic_pen

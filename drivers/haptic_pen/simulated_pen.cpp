#include "drivers/haptic_pen/simulated_pen.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace prismesh::drivers::haptic_pen {
namespace {

constexpr std::int64_t kStepNs = 20'000;
/// Below this speed friction holds the pen.
constexpr double kRestMmS = 0.01;

}  // namespace

SimulatedPen::SimulatedPen(const SimulatedPenOptions& options, HandSource hand)
    : options_(options), hand_(std::move(hand)), random_(options.seed) {
  limits_.max_newton = options.max_newton;
  limits_.max_axis_newton.setConstant(options.max_newton);
  limits_.damping_newton_s_m = options.damping_newton_s_m;
  limits_.friction_newton = options.friction_newton;
  limits_.quantum_mm = options.quantum_mm;
  const std::int64_t ticks =
      std::max<std::int64_t>(1, (options.pose_delay_ns + options.jitter_ns + options.period_ns - 1) / options.period_ns);
  limits_.delay_ns = ticks * options.period_ns + options.force_delay_ns;
  limits_.workspace_min_mm.setConstant(-options.workspace_mm);
  limits_.workspace_max_mm.setConstant(options.workspace_mm);
}

PenReading SimulatedPen::read(std::int64_t now_ns) {
  run_until(now_ns);
  PenReading reading;
  reading.phase = unplugged_ ? PenPhase::absent : PenPhase::ready;
  reading.trouble = unplugged_ ? PenTrouble::io_error : PenTrouble::none;
  if (unplugged_) return reading;
  std::size_t arrived = 0;
  while (arrived < answer_count_ && answers_[arrived].at_ns <= now_ns) ++arrived;
  if (arrived > 0) {
    reading.fresh = true;
    reading.replies = static_cast<std::uint32_t>(arrived);
    reading.pose = answers_[arrived - 1].pose;
    std::move(answers_.begin() + static_cast<std::ptrdiff_t>(arrived), answers_.begin() + static_cast<std::ptrdiff_t>(answer_count_),
              answers_.begin());
    answer_count_ -= arrived;
  }
  reading.lost_replies = std::exchange(lost_, 0);
  reading.buttons = buttons_;
  return reading;
}

void SimulatedPen::send(std::int64_t now_ns, const PenCommand& command) {
  run_until(now_ns);
  if (unplugged_) return;
  if (sent_count_ < sent_.size()) sent_[sent_count_++] = {now_ns + options_.force_delay_ns, command};
  if (replies_to_lose_ > 0) {
    --replies_to_lose_;
    ++lost_;
    return;
  }
  if (answer_count_ == answers_.size()) return;
  // The position is that of this moment, and arrives later; answers don't overtake each other.
  Answer answer;
  answer.at_ns = now_ns + options_.pose_delay_ns + jitter_ns();
  if (answer_count_ > 0) answer.at_ns = std::max(answer.at_ns, answers_[answer_count_ - 1].at_ns);
  answer.pose.measured_ns = now_ns;
  for (int axis = 0; axis < 3; ++axis)
    answer.pose.position_mm[axis] =
        options_.quantum_mm > 0 ? std::round(position_mm_[axis] / options_.quantum_mm) * options_.quantum_mm : position_mm_[axis];
  answers_[answer_count_++] = answer;
}

void SimulatedPen::run_until(std::int64_t now_ns) {
  if (!started_) {
    started_ = true;
    start_ns_ = now_ns_ = now_ns;
    position_mm_ = hand_(0).goal_mm;
  }
  while (now_ns_ < now_ns) {
    const std::int64_t step_ns = std::min(kStepNs, now_ns - now_ns_);
    while (sent_count_ > 0 && sent_[0].at_ns <= now_ns_) {
      applied_ = sent_[0].command;
      std::move(sent_.begin() + 1, sent_.begin() + static_cast<std::ptrdiff_t>(sent_count_--), sent_.begin());
    }
    // The device's own watchdog.
    if (unplugged_ || now_ns_ > applied_.valid_until_ns + options_.force_delay_ns) applied_.newton.setZero();
    move(step_ns);
    now_ns_ += step_ns;
  }
}

void SimulatedPen::move(std::int64_t step_ns) {
  const double seconds = static_cast<double>(step_ns) * 1e-9;
  const SimulatedHand hand = hand_(static_cast<double>(now_ns_ - start_ns_) * 1e-9);
  buttons_ = hand.buttons;
  const Eigen::Vector3d push_newton = applied_.newton + hand.push_newton + hand.stiffness_newton_m * 1e-3 * (hand.goal_mm - position_mm_) -
                                      (hand.damping_newton_s_m + options_.damping_newton_s_m) * 1e-3 * velocity_mm_s_;
  const double speed = velocity_mm_s_.norm();
  Eigen::Vector3d friction_newton = Eigen::Vector3d::Zero();
  if (speed > kRestMmS) {
    // No more than what stops the pen within this step.
    const double stop_newton = options_.mass_kg * speed * 1e-3 / seconds;
    friction_newton = -std::min(options_.friction_newton, stop_newton) / speed * velocity_mm_s_;
  } else if (push_newton.norm() <= options_.friction_newton) {
    velocity_mm_s_.setZero();
    return;
  } else {
    friction_newton = -options_.friction_newton * push_newton.normalized();
  }
  velocity_mm_s_ += (push_newton + friction_newton) / options_.mass_kg * seconds * 1e3;
  const Eigen::Vector3d way_mm = velocity_mm_s_ * seconds;
  position_mm_ += way_mm;
  motor_joule_ += applied_.newton.dot(way_mm) * 1e-3;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(position_mm_[axis]) <= options_.workspace_mm) continue;
    position_mm_[axis] = std::copysign(options_.workspace_mm, position_mm_[axis]);
    velocity_mm_s_[axis] = 0;
  }
}

/// SplitMix64 [Steele 2014].
std::int64_t SimulatedPen::jitter_ns() {
  if (options_.jitter_ns <= 0) return 0;
  std::uint64_t z = random_ += 0x9E3779B97F4A7C15u;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return static_cast<std::int64_t>((z ^ (z >> 31)) % static_cast<std::uint64_t>(options_.jitter_ns));
}

}  // namespace prismesh::drivers::haptic_pen

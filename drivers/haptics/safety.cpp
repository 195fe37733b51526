#include "drivers/haptics/safety.h"

#include <algorithm>
#include <cmath>

namespace prismesh::drivers::haptics {
namespace {

double seconds_of(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

/// Bounds times from outside, so that differences of two never overflow.
bool plausible_time(std::int64_t ns) { return ns >= 0 && ns < std::int64_t{1} << 62; }

/// Below 0: the clock went back, or one of the times can't be.
std::int64_t passed(std::int64_t from_ns, std::int64_t to_ns) {
  return plausible_time(from_ns) && plausible_time(to_ns) ? to_ns - from_ns : -1;
}

/// Numbers beyond this are as wrong as infinity, and products of two would be infinite.
constexpr double kMaxNumber = 1e6;

/// False for NaN.
bool plausible(const Eigen::Vector3d& vector) {
  return std::abs(vector.x()) <= kMaxNumber && std::abs(vector.y()) <= kMaxNumber && std::abs(vector.z()) <= kMaxNumber;
}

bool all_plausible(const SafetyInput& input) {
  bool all = plausible(input.position_mm);
  for (const ForcePart& part : input.parts) all = all && plausible(part.newton);
  return all;
}

/// Shortens a vector to a length.
Eigen::Vector3d shortened(const Eigen::Vector3d& vector, double max_length) {
  const double length = vector.norm();
  return length > max_length ? Eigen::Vector3d(vector * (max_length / length)) : vector;
}

}  // namespace

Safety::Safety(const HapticLimits& limits, const Eigen::Vector3d& max_axis_newton, const SafetyRecord& stored)
    : limits_(limits), max_axis_newton_(max_axis_newton), allowance_joule_(limits.burst_joule) {
  if (stored.phase == SafetyPhase::disarmed) return;
  record_ = stored;
  record_.phase = SafetyPhase::latched;
  if (stored.phase != SafetyPhase::latched) record_.fault = SafetyFault::died_armed;
  record_changed_ = record_ != stored;
}

SafetyOutput Safety::step(const SafetyInput& input) {
  SafetyOutput output;
  const std::int64_t passed_ns = started_ ? passed(last_ns_, input.now_ns) : limits_.period_ns;
  lapsed_ = passed_ns > limits_.period_ns + limits_.late_ns;
  const SafetyFault fault = find_fault(input, passed_ns);
  allowance_joule_ =
      std::min(limits_.burst_joule, allowance_joule_ + limits_.steady_watt * seconds_of(std::max<std::int64_t>(0, passed_ns)));
  output.speed_mm_s = speed_mm_s();
  if (record_.phase == SafetyPhase::armed && (fault != SafetyFault::none || !input.ready))
    enter(fault != SafetyFault::none ? SafetyPhase::latched : SafetyPhase::disarmed, fault, input.now_ns);
  // A fault of a loop that isn't armed takes the place of no other one: it only keeps the user from arming.
  if (input.rearm && !rearm_before_) {
    output.rearm_refused = true;
    if (fault == SafetyFault::none) try_to_arm(input, output);
  }
  rearm_before_ = input.rearm;
  started_ = true;
  last_ns_ = input.now_ns;

  Eigen::Vector3d newton = Eigen::Vector3d::Zero();
  output.valid_until_ns = input.now_ns + limits_.period_ns + limits_.late_ns;
  if (record_.phase == SafetyPhase::armed) {
    output.damping_only = lapsed_ || input.now_ns - poses_[newest_pose_].measured_ns > limits_.pose_old_ns;
    if (lapsed_) sent_newton_.setZero();
    newton = limit_rise(faded_sum(input, output.damping_only), passed_ns);
    newton = shortened(newton, max_length(input.now_ns));
    const double tank = tank_length(output.valid_until_ns);
    output.tank_limited = newton.norm() > tank;
    newton = shortened(newton, tank);
    // One share for all axes keeps the direction.
    for (int axis = 0; axis < 3; ++axis)
      if (std::abs(newton[axis]) > max_axis_newton_[axis]) newton *= max_axis_newton_[axis] / std::abs(newton[axis]);
  }
  sent_newton_ = output.newton = newton;
  if (since_pose_count_ < since_pose_.size()) ++since_pose_count_;
  since_pose_[since_pose_count_ - 1] = newton;
  output.record = record_;
  output.record_changed = record_changed_;
  record_changed_ = false;
  output.tank_joule = allowance_joule_ + credit_joule_;
  return output;
}

SafetyFault Safety::find_fault(const SafetyInput& input, std::int64_t passed_ns) {
  if (!all_plausible(input)) return SafetyFault::not_finite;
  if (passed_ns < 0 || !plausible_time(input.now_ns)) return SafetyFault::clock;
  const SafetyFault pose_fault = take_pose(input);
  if (input.io_error) return SafetyFault::io_error;
  if (input.lost_replies > 0) return SafetyFault::lost_reply;
  if (pose_fault != SafetyFault::none) return pose_fault;
  if (passed_ns - limits_.period_ns > limits_.latch_late_ns) return SafetyFault::late_tick;
  if (pose_count_ == 0 || input.now_ns - poses_[newest_pose_].measured_ns > limits_.pose_lost_ns) return SafetyFault::no_pose;
  if (speed_mm_s() > limits_.max_speed_mm_s) return SafetyFault::too_fast;
  return SafetyFault::none;
}

/// Compares a new pose with the one before and accounts for the work of the way between. After a fault the ring begins anew with it.
SafetyFault Safety::take_pose(const SafetyInput& input) {
  if (input.measured_ns == 0) return SafetyFault::none;
  if (!plausible_time(input.measured_ns) || input.measured_ns > input.now_ns) return SafetyFault::pose_time;
  SafetyFault fault = SafetyFault::none;
  if (pose_count_ > 0) {
    const Pose& before = poses_[newest_pose_];
    const Eigen::Vector3d moved_mm = input.position_mm - before.position_mm;
    if (input.measured_ns == before.measured_ns) return moved_mm.isZero(0) ? SafetyFault::none : SafetyFault::pose_time;
    if (input.measured_ns < before.measured_ns) {
      fault = SafetyFault::pose_time;
    } else if (moved_mm.norm() > max_way_mm(input.measured_ns)) {
      fault = SafetyFault::jump;
    } else {
      account(moved_mm);
    }
  }
  if (fault != SafetyFault::none) pose_count_ = 0;
  newest_pose_ = pose_count_ == 0 ? 0 : (newest_pose_ + 1) % poses_.size();
  pose_count_ = std::min(pose_count_ + 1, poses_.size());
  poses_[newest_pose_] = {input.measured_ns, input.position_mm};
  since_pose_count_ = 0;
  return fault;
}

/// Work of the forces on the way that the hand went. Where several forces were sent on this way, it isn't known which part of the way each
/// of them has seen: the most work into the hand counts. Where the last command has ended before this tick, the hand may have gone any part
/// of the way with it: it gets no credit, and may have got work on as much of the way as it can go in that time.
void Safety::account(const Eigen::Vector3d& moved_mm) {
  if (since_pose_count_ == 0) return;
  Eigen::Vector3d way_mm = moved_mm;
  if (lapsed_) way_mm = shortened(moved_mm, max_way_mm(last_ns_ + limits_.period_ns + limits_.late_ns));
  double joule = since_pose_[0].dot(way_mm) * 1e-3;
  for (std::size_t i = 1; i < since_pose_count_; ++i) joule = std::max(joule, since_pose_[i].dot(way_mm) * 1e-3);
  if (lapsed_) joule = std::max(0.0, joule);
  if (joule <= 0) {
    credit_joule_ = std::min(limits_.max_credit_joule, credit_joule_ - joule);
  } else {
    const double from_credit = std::min(credit_joule_, joule);
    credit_joule_ -= from_credit;
    allowance_joule_ -= joule - from_credit;
  }
}

/// Mean speed from the newest pose that is at least the window's length older than the last one; of the oldest one if all are younger.
double Safety::speed_mm_s() const {
  if (pose_count_ < 2) return 0;
  const Pose& newest = poses_[newest_pose_];
  const Pose* from = &newest;
  for (std::size_t back = 1; back < pose_count_; ++back) {
    from = &poses_[(newest_pose_ + poses_.size() - back) % poses_.size()];
    if (newest.measured_ns - from->measured_ns >= limits_.speed_window_ns) break;
  }
  const std::int64_t ns = newest.measured_ns - from->measured_ns;
  // A shorter way than the window can't be told from the resolution of the device; jumps are found elsewhere.
  return (newest.position_mm - from->position_mm).norm() / seconds_of(std::max(ns, limits_.speed_window_ns));
}

Eigen::Vector3d Safety::faded_sum(const SafetyInput& input, bool damping_only) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const ForcePart& part : input.parts) {
    if (damping_only && !part.damping) continue;
    double share = 1;
    if (part.from_ns != 0) {
      if (!plausible_time(part.from_ns)) continue;
      const std::int64_t age_ns = input.now_ns - part.from_ns;
      if (age_ns < -limits_.ahead_ns) continue;
      share = std::clamp(1 - static_cast<double>(age_ns - limits_.field_old_ns) / static_cast<double>(limits_.fade_ns), 0.0, 1.0);
    }
    sum += share * part.newton;
  }
  return sum;
}

/// Falls are free: the nearest point to the wanted force on the way from the last force to zero. What is still missing is a rise.
Eigen::Vector3d Safety::limit_rise(const Eigen::Vector3d& newton, std::int64_t passed_ns) const {
  const double last = sent_newton_.squaredNorm();
  const double kept = last > 0 ? std::clamp(newton.dot(sent_newton_) / last, 0.0, 1.0) : 0;
  const Eigen::Vector3d fallen = kept * sent_newton_;
  const Eigen::Vector3d rise = newton - fallen;
  const double max_rise = limits_.max_rise_newton_s * seconds_of(std::min(passed_ns, 2 * limits_.period_ns));
  return fallen + rise * std::min(1.0, max_rise / std::max(rise.norm(), 1e-12));
}

double Safety::max_length(std::int64_t now_ns) const {
  const double part = static_cast<double>(now_ns - record_.since_ns) / static_cast<double>(limits_.start_ns);
  const double start = std::min(limits_.start_newton, limits_.max_newton);
  return start + (limits_.max_newton - start) * std::clamp(part, 0.0, 1.0);
}

/// The longest way from the newest pose until a time: longer ones are jumps.
double Safety::max_way_mm(std::int64_t until_ns) const {
  return limits_.jump_mm + limits_.max_speed_mm_s * seconds_of(until_ns - poses_[newest_pose_].measured_ns);
}

/// The longest force whose work is paid for on the longest way that the hand can go before the command ends.
double Safety::tank_length(std::int64_t valid_until_ns) const {
  return std::max(0.0, allowance_joule_ + credit_joule_) / (max_way_mm(valid_until_ns) * 1e-3);
}

void Safety::try_to_arm(const SafetyInput& input, SafetyOutput& output) {
  if (record_.phase == SafetyPhase::armed) {
    output.rearm_refused = false;
    return;
  }
  const bool free = faded_sum(input, false).norm() <= limits_.start_newton;
  if (!input.ready || !free) return;
  output.rearm_refused = false;
  enter(SafetyPhase::armed, SafetyFault::none, input.now_ns);
}

void Safety::enter(SafetyPhase phase, SafetyFault fault, std::int64_t now_ns) {
  record_ = {phase, fault, now_ns};
  record_changed_ = true;
  sent_newton_.setZero();
  // What the hand put in before doesn't count for what follows.
  credit_joule_ = 0;
}

}  // namespace prismesh::drivers::haptics

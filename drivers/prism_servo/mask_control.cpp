#include "drivers/prism_servo/mask_control.h"

#include <algorithm>
#include <cmath>

namespace prismesh::drivers::prism_servo {
namespace {

constexpr std::int64_t kMaxAheadNs = 100'000'000;
/// After a stall the command advances as if only so long had passed.
constexpr std::int64_t kMaxStepNs = 20'000'000;
constexpr std::int64_t kMaxLagNs = 200'000'000;
/// Part of a move back's duration: time to come to rest, in addition to the travel time.
constexpr std::int64_t kRestNs = 30'000'000;
constexpr std::int64_t kLagsToRest = 4;
/// Envelope of a healthy motor: between the command itself and a motor with three times the lag at 70 % of the speed.
constexpr double kSlowLags = 3;
constexpr double kSlowSpeed = 0.7;
/// Time difference for the numerical derivative of the target.
constexpr std::int64_t kSlopeNs = 20'000'000;

bool finite(const eye_tracker::HeadState& head) {
  return head.between_eyes_mm.allFinite() && head.velocity_mm_s.allFinite() && head.toward_right.allFinite();
}

double step_toward(double from, double to, double max_step) { return from + std::clamp(to - from, -max_step, max_step); }

std::int64_t ns_of(double seconds) { return static_cast<std::int64_t>(seconds * 1e9); }

}  // namespace

double mask_position_at(const MaskState& state, std::int64_t time_ns) {
  if (state.measured_ns == 0) return state.position_mm;
  const auto seconds = [](std::int64_t ns) { return static_cast<double>(std::clamp<std::int64_t>(ns, -kMaxAheadNs, kMaxAheadNs)) * 1e-9; };
  const double lag = std::max(1e-3, seconds(state.lag_ns));
  // A motor with first-order lag follows a moving goal at a distance of velocity times lag; the present deviation from that decays
  // exponentially.
  const auto behind_goal = [&](std::int64_t ns) { return state.goal_mm + state.goal_velocity_mm_s * (seconds(ns - state.time_ns) - lag); };
  const double off = state.position_mm - behind_goal(state.measured_ns);
  const std::int64_t until_ns = std::max(time_ns, state.measured_ns);
  return behind_goal(until_ns) + off * std::exp(-seconds(until_ns - state.measured_ns) / lag);
}

MaskControl::MaskControl(const display::MaskOptics& optics, const MaskLimits& limits) : optics_(optics), limits_(limits) {}

void MaskControl::set_optics(const display::MaskOptics& optics) {
  optics_ = optics;
  if (state_.phase == MaskPhase::following || state_.phase == MaskPhase::flying_back) start_following(state_.half_periods);
}

MaskControl::Output MaskControl::step(const Input& input) {
  const std::int64_t passed = started_ ? std::clamp<std::int64_t>(input.now_ns - state_.time_ns, 0, kMaxStepNs) : 0;
  started_ = true;
  state_.time_ns = input.now_ns;
  state_.lag_ns = lag_ns_ = std::clamp<std::int64_t>(input.servo_lag_ns, 0, kMaxLagNs);
  const bool servo_ready = read_sensors(input);
  target_velocity_mm_s_ = 0;
  decide(input, servo_ready);
  move_command(static_cast<double>(passed) * 1e-9);
  if (powered_ && servo_ready) watch_motor(input);
  state_.goal_mm = command_mm_;
  state_.stereo_allowed = state_.phase == MaskPhase::following && caught_up_;
  if (state_.phase == MaskPhase::held) state_.stereo_allowed = arrived_;
  return {command_mm_, powered_, state_};
}

/// Reads the head's and the servo's measurements. Returns whether the servo is ready and answers.
bool MaskControl::read_sensors(const Input& input) {
  const std::int64_t age = input.now_ns - input.head.time_ns;
  head_seen_ =
      input.head_seen && input.head.time_ns != 0 && finite(input.head) && age <= limits_.eyes_lost_ns && age >= -limits_.eyes_lost_ns;
  const MaskReading& reading = input.servo.reading;
  if (reading.measured_ns != 0 && std::isfinite(reading.position_mm) && std::isfinite(reading.velocity_mm_s)) {
    state_.measured_ns = reading.measured_ns;
    state_.position_mm = reading.position_mm;
    state_.velocity_mm_s = reading.velocity_mm_s;
  }
  return input.servo.phase == ServoPhase::ready && input.servo.status != port::PortStatus::gone && state_.measured_ns != 0 &&
         input.now_ns - state_.measured_ns <= limits_.reading_old_ns;
}

void MaskControl::decide(const Input& input, bool servo_ready) {
  if (input.rearm) rearm(input);
  if (rearming_until_ns_ != 0) {
    if (servo_ready || input.now_ns > rearming_until_ns_) {
      rearming_until_ns_ = 0;
      enter(MaskPhase::absent);
    } else {
      // Torque was off before; requesting it again makes the servo restart.
      return set_powered(input.servo.phase == ServoPhase::alarm);
    }
  }
  if (input.servo.phase == ServoPhase::alarm && fault_ == MaskPhase::absent) latch(MaskPhase::alarm);
  if (fault_ != MaskPhase::absent) return set_powered(false);
  if (!servo_ready) {
    if (state_.phase != MaskPhase::absent) enter(MaskPhase::absent);
    return set_powered(false);
  }
  if (state_.phase == MaskPhase::absent) enter(MaskPhase::homing);
  if (input.hold_mm != nullptr && state_.phase != MaskPhase::homing && state_.phase != MaskPhase::held) enter(MaskPhase::held);
  set_powered(true);
  switch (state_.phase) {
    case MaskPhase::homing: return home(input);
    case MaskPhase::following: return follow(input);
    case MaskPhase::flying_back: return fly_back(input);
    case MaskPhase::frozen: return freeze(input);
    case MaskPhase::parking:
    case MaskPhase::parked:
      if (head_seen_) return start_following(middle_periods(ideal_mm(input, lag_ns_)));
      return park();
    case MaskPhase::held: return hold(input);
    case MaskPhase::absent:
    case MaskPhase::stuck:
    case MaskPhase::alarm: return;
  }
}

void MaskControl::enter(MaskPhase phase) {
  state_.phase = phase;
  state_.mono_from_ns = state_.mono_until_ns = 0;
  phase_since_ns_ = state_.time_ns;
  caught_up_ = arrived_ = false;
  on_target_since_ns_ = 0;
  if (phase != MaskPhase::following && phase != MaskPhase::frozen) state_.half_periods = 0;
}

void MaskControl::rearm(const Input& input) {
  fault_ = MaskPhase::absent;
  set_powered(false);
  enter(MaskPhase::homing);
  rearming_until_ns_ = input.now_ns + limits_.rearm_ns;
}

void MaskControl::latch(MaskPhase fault) {
  fault_ = fault;
  enter(fault);
  set_powered(false);
}

void MaskControl::home(const Input& input) {
  target_mm_ = 0;
  if (!arrived_) return;
  if (head_seen_) return start_following(middle_periods(ideal_mm(input, lag_ns_)));
  enter(MaskPhase::parking);
}

void MaskControl::start_following(std::int32_t half_periods) {
  enter(MaskPhase::following);
  state_.half_periods = half_periods;
}

void MaskControl::follow(const Input& input) {
  if (!head_seen_) return enter(MaskPhase::frozen);
  const double ideal = ideal_mm(input, lag_ns_);
  // No stereo is visible before the mask has caught up, so a move needs no announcement.
  if (!caught_up_ && std::abs(ideal - state_.half_periods * half_period_mm()) > return_mm()) state_.half_periods = middle_periods(ideal);
  update_target(input);
  caught_up_ = caught_up_ || arrived_;
  if (caught_up_) plan_return(input);
}

/// Announces a move back, and starts it when the last stereo picture is no longer visible.
void MaskControl::plan_return(const Input& input) {
  if (state_.mono_from_ns == 0) {
    const double then = ideal_mm(input, lag_ns_ + limits_.return_notice_ns);
    const std::int32_t next = periods_back(then, state_.half_periods);
    if (std::abs(then - state_.half_periods * half_period_mm()) <= return_mm() || next == state_.half_periods) return;
    state_.mono_from_ns = input.now_ns + limits_.return_notice_ns;
    const double distance = std::abs(next - state_.half_periods) * half_period_mm();
    state_.mono_until_ns = state_.mono_from_ns + limits_.picture_ns + flight_ns(distance);
    return;
  }
  if (input.now_ns < state_.mono_from_ns + limits_.picture_ns) return;
  const double ideal = ideal_mm(input, lag_ns_);
  const std::int32_t next = periods_back(ideal, state_.half_periods);
  const double distance = std::abs(next - state_.half_periods) * half_period_mm();
  if (next == state_.half_periods || input.now_ns + flight_ns(distance) > state_.mono_until_ns + limits_.return_notice_ns / 4) {
    // The head has turned back meanwhile: drop this move; another one needs its own announcement.
    if (input.now_ns >= state_.mono_until_ns) state_.mono_from_ns = state_.mono_until_ns = 0;
    return;
  }
  state_.phase = MaskPhase::flying_back;
  state_.half_periods = next;
  phase_since_ns_ = input.now_ns;
  caught_up_ = arrived_ = false;
  on_target_since_ns_ = 0;
  fly_back(input);
}

void MaskControl::fly_back(const Input& input) {
  if (!head_seen_) return enter(MaskPhase::frozen);
  update_target(input);
  caught_up_ = caught_up_ || arrived_;
  if (!caught_up_) {
    // Publishes a delay as soon as it is known, with at least the notice of a move.
    const std::int64_t needed = flight_ns(std::abs(state_.position_mm - target_mm_) - limits_.settle_mm);
    state_.mono_until_ns = std::max(state_.mono_until_ns, input.now_ns + std::max(needed, limits_.return_notice_ns));
    return;
  }
  if (input.now_ns < state_.mono_until_ns) return;
  const std::int32_t half_periods = state_.half_periods;
  start_following(half_periods);
  caught_up_ = true;
}

void MaskControl::freeze(const Input& input) {
  target_mm_ = command_mm_;
  const bool may_move = input.picture_mono || input.now_ns - phase_since_ns_ >= limits_.park_after_ns;
  if (!head_seen_) {
    if (may_move) enter(MaskPhase::parking);
    return;
  }
  const double ideal = ideal_mm(input, lag_ns_);
  const bool in_reach = std::abs(ideal - state_.half_periods * half_period_mm()) <= return_mm();
  if (in_reach) return start_following(state_.half_periods);
  if (may_move) start_following(middle_periods(ideal));
}

void MaskControl::park() {
  target_mm_ = 0;
  if (state_.phase == MaskPhase::parked) return set_powered(false);
  if (!arrived_) return;
  enter(MaskPhase::parked);
  set_powered(false);
}

void MaskControl::hold(const Input& input) {
  if (input.hold_mm == nullptr) {
    if (!head_seen_) return enter(MaskPhase::frozen);
    return start_following(middle_periods(ideal_mm(input, lag_ns_)));
  }
  if (std::isfinite(*input.hold_mm)) target_mm_ = in_travel(*input.hold_mm);
}

// --- target position ---

double MaskControl::ideal_mm(const Input& input, std::int64_t ahead_ns) const {
  const double place = display::mask_position_mm(optics_, eye_tracker::predict(input.head, input.now_ns + ahead_ns));
  return std::isfinite(place) ? place : 0;
}

void MaskControl::update_target(const Input& input) {
  const double back = state_.half_periods * half_period_mm();
  target_mm_ = in_travel(ideal_mm(input, lag_ns_) - back);
  const double later = in_travel(ideal_mm(input, lag_ns_ + kSlopeNs) - back);
  target_velocity_mm_s_ = (later - target_mm_) / (static_cast<double>(kSlopeNs) * 1e-9);
}

double MaskControl::half_period_mm() const { return optics_.mask_pitch_mm() / 2; }

double MaskControl::in_travel(double mm) const { return std::clamp(mm, -limits_.travel_mm, limits_.travel_mm); }

/// Returns the min. number of half (or whole) periods back that leaves half a step of travel before the next move.
std::int32_t MaskControl::periods_back(double ideal_mm, std::int32_t now) const {
  const std::int32_t unit = limits_.half_period_returns ? 1 : 2;
  const double step = unit * half_period_mm();
  const double place = ideal_mm - now * half_period_mm();
  if (!(step > 0)) return now;
  const auto steps = static_cast<std::int32_t>(std::ceil((std::abs(place) - return_mm()) / step + 0.5));
  if (steps <= 0) return now;
  const std::int32_t back = now + (place > 0 ? 1 : -1) * steps * unit;
  // With a short travel this may be too far on the other side.
  return std::abs(ideal_mm - back * half_period_mm()) <= return_mm() ? back : middle_periods(ideal_mm);
}

std::int32_t MaskControl::middle_periods(double ideal_mm) const {
  const std::int32_t unit = limits_.half_period_returns ? 1 : 2;
  const double step = unit * half_period_mm();
  return step > 0 ? unit * static_cast<std::int32_t>(std::lround(ideal_mm / step)) : 0;
}

std::int64_t MaskControl::flight_ns(double distance_mm) const {
  return ns_of(std::max(distance_mm, 0.0) / (0.9 * limits_.speed_mm_s)) + kLagsToRest * lag_ns_ + kRestNs;
}

// --- motor ---

/// Switches the torque; the command starts at the motor's present position.
void MaskControl::set_powered(bool powered) {
  if (powered && !powered_) reset_command();
  powered_ = powered;
  if (!powered) reset_command();
}

void MaskControl::reset_command() {
  command_mm_ = quick_mm_ = slow_mm_ = slow_profile_mm_ = in_travel(state_.position_mm);
  target_mm_ = command_mm_;
  arrived_ = false;
  on_target_since_ns_ = deviating_since_ns_ = 0;
  trace_count_ = 0;
  record_trace();
}

void MaskControl::move_command(double seconds) {
  const double before = command_mm_;
  if (powered_) {
    command_mm_ = step_toward(command_mm_, target_mm_, limits_.speed_mm_s * seconds);
    const double lag_s = std::max(1e-3, static_cast<double>(lag_ns_) * 1e-9);
    quick_mm_ = step_toward(quick_mm_, command_mm_, limits_.speed_mm_s * seconds);
    slow_profile_mm_ = step_toward(slow_profile_mm_, command_mm_, kSlowSpeed * limits_.speed_mm_s * seconds);
    slow_mm_ += (slow_profile_mm_ - slow_mm_) * (1 - std::exp(-seconds / (kSlowLags * lag_s)));
    record_trace();
  }
  const bool on_target = powered_ && std::abs(command_mm_ - target_mm_) < 1e-9;
  if (!on_target)
    on_target_since_ns_ = 0;
  else if (on_target_since_ns_ == 0)
    on_target_since_ns_ = state_.time_ns;
  const bool follows_head = on_target || state_.phase == MaskPhase::following;
  state_.goal_velocity_mm_s = follows_head ? target_velocity_mm_s_ : seconds > 0 ? (command_mm_ - before) / seconds : 0;
}

void MaskControl::record_trace() {
  newest_trace_ = (newest_trace_ + 1) % traces_.size();
  traces_[newest_trace_] = {state_.time_ns, command_mm_, quick_mm_, slow_mm_};
  trace_count_ = std::min(trace_count_ + 1, traces_.size());
}

/// Returns the trace at a time, or the oldest one.
const MaskControl::Trace& MaskControl::trace_at(std::int64_t time_ns) const {
  std::size_t at = newest_trace_;
  for (std::size_t i = 1; i < trace_count_ && traces_[at].time_ns > time_ns; ++i) at = (at + traces_.size() - 1) % traces_.size();
  return traces_[at];
}

/// Compares the measurement with the envelope of a healthy motor.
void MaskControl::watch_motor(const Input& input) {
  if (!input.servo.fresh) return;
  const Trace& then = trace_at(state_.measured_ns);
  const Trace& commanded = trace_at(state_.measured_ns - lag_ns_);
  const bool target_was_commanded = on_target_since_ns_ != 0 && commanded.time_ns >= on_target_since_ns_;
  arrived_ = target_was_commanded && std::abs(state_.position_mm - commanded.command_mm) <= limits_.settle_mm;
  const double low = std::min(then.quick_mm, then.slow_mm), high = std::max(then.quick_mm, then.slow_mm);
  if (state_.position_mm >= low - limits_.stuck_mm && state_.position_mm <= high + limits_.stuck_mm) {
    deviating_since_ns_ = 0;
    return;
  }
  if (deviating_since_ns_ == 0) deviating_since_ns_ = state_.measured_ns;
  if (state_.measured_ns - deviating_since_ns_ >= limits_.stuck_after_ns) latch(MaskPhase::stuck);
}

}  // namespace prismesh::drivers::prism_servo

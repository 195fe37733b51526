#include "drivers/haptics/replay.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace prismesh::drivers::haptics {
namespace {

constexpr std::int64_t kRestNs = 500'000'000;   ///< refills the allowance (HapticLimits::burst_joule at steady_watt)
constexpr std::size_t kTicksBeforeArming = 40;  ///< more than the safety remembers of poses

Eigen::Vector3d recorded_vector(const double (&numbers)[3]) { return {numbers[0], numbers[1], numbers[2]}; }

SafetyPhase phase_of(std::uint8_t number) {
  return number > static_cast<std::uint8_t>(SafetyPhase::latched) ? SafetyPhase::latched : static_cast<SafetyPhase>(number);
}
SafetyFault fault_of(std::uint8_t number) { return static_cast<SafetyFault>(number); }

/// From one time to another; a record may hold any numbers.
std::int64_t passed_ns(std::int64_t from, std::int64_t to) {
  std::int64_t passed = 0;
  return __builtin_sub_overflow(to, from, &passed) ? 0 : passed;
}

/// The same bits, so that a force that isn't a number equals itself.
bool same_bits(const Eigen::Vector3d& a, const double (&b)[3]) {
  const auto same = [&](int axis) { return std::bit_cast<std::uint64_t>(a[axis]) == std::bit_cast<std::uint64_t>(b[axis]); };
  return same(0) && same(1) && same(2);
}

class Replay {
 public:
  explicit Replay(const PenRecord& record) : record_(record), safety_(made({})) {
    if (record.ticks.empty() || record.ticks.front().phase == static_cast<std::uint8_t>(SafetyPhase::armed)) return;
    safety_ = made({phase_of(record.ticks.front().phase), fault_of(record.ticks.front().fault), 0});
    decides_ = true;
  }

  ReplayReport run() {
    for (std::size_t t = 0; t < record_.ticks.size(); ++t) take(t);
    if (!record_.ticks.empty())
      report_.seconds = static_cast<double>(passed_ns(record_.ticks.front().now_ns, record_.ticks.back().now_ns)) * 1e-9;
    return report_;
  }

 private:
  Safety made(const SafetyRecord& stored) const {
    HapticLimits limits;
    limits.max_newton = record_.limits.max_newton;
    return Safety(limits, recorded_vector(record_.limits.max_axis_newton), stored);
  }

  void take(std::size_t t) {
    const PenTick& tick = record_.ticks[t];
    const bool armed = phase_of(tick.phase) == SafetyPhase::armed;
    if (tick.begins != 0) {
      safety_ = made({phase_of(tick.stored_phase), fault_of(tick.stored_fault), 0});
      decides_ = exact_ = true;
    }
    note(t);
    const bool was_armed = safety_.record().phase == SafetyPhase::armed;
    SafetyInput input = input_of(tick);
    if (!decides_ && t >= kTicksBeforeArming && armed && !was_armed) {
      // Not compared yet; the rise of the input counts.
      input.rearm = !rearm_before_;
    }
    rearm_before_ = input.rearm;
    const SafetyOutput output = safety_.step(input);
    report_.max_speed_mm_s = std::max(report_.max_speed_mm_s, output.speed_mm_s);
    if (!decides_) {
      decides_ = armed == (output.record.phase == SafetyPhase::armed) && t >= kTicksBeforeArming;
    } else {
      if (armed && !was_armed && rest_ns_ >= kRestNs) exact_ = true;
      compare(t, output);
    }
    rest_ns_ =
        armed || t == 0 ? 0 : std::min(rest_ns_, kRestNs) + std::max<std::int64_t>(0, passed_ns(record_.ticks[t - 1].now_ns, tick.now_ns));
  }

  void note(std::size_t t) {
    const PenTick& tick = record_.ticks[t];
    const PenTick* before = t > 0 ? &record_.ticks[t - 1] : nullptr;
    if (before == nullptr || before->phase != tick.phase || before->fault != tick.fault)
      report_.changes.push_back({t, phase_of(tick.phase), fault_of(tick.fault)});
    if (before != nullptr) report_.worst_gap_ns = std::max(report_.worst_gap_ns, passed_ns(before->now_ns, tick.now_ns));
    const double newton = recorded_vector(tick.newton).norm();
    if (!(newton <= report_.max_newton)) report_.max_newton = newton;
    report_.lost_replies += tick.lost_replies;
    report_.limited_ticks += tick.tank_limited;
  }

  SafetyInput input_of(const PenTick& tick) {
    for (std::size_t kind = 0; kind < kForceKinds; ++kind)
      parts_[kind] = {recorded_vector(tick.parts[kind].newton), tick.parts[kind].from_ns,
                      kind == static_cast<std::size_t>(ForceKind::damping)};
    SafetyInput input;
    input.now_ns = tick.now_ns;
    input.position_mm = recorded_vector(tick.position_mm);
    input.measured_ns = tick.measured_ns;
    input.ready = tick.ready != 0;
    input.io_error = tick.io_error != 0;
    input.lost_replies = tick.lost_replies;
    input.parts = parts_;
    input.rearm = tick.rearm != 0;
    return input;
  }

  void compare(std::size_t t, const SafetyOutput& output) {
    const PenTick& tick = record_.ticks[t];
    ++report_.decisions_compared;
    report_.forces_compared += exact_;
    const bool same = static_cast<std::uint8_t>(output.record.phase) == tick.phase &&
                      static_cast<std::uint8_t>(output.record.fault) == tick.fault && (!exact_ || same_bits(output.newton, tick.newton));
    if (same) return;
    ++report_.differing;
    if (!report_.first_difference) report_.first_difference = t;
  }

  const PenRecord& record_;
  Safety safety_;
  std::array<ForcePart, kForceKinds> parts_;
  ReplayReport report_;
  bool decides_ = false;  ///< phase and fault are those of the record
  bool exact_ = false;    ///< the force is, too
  bool rearm_before_ = true;
  std::int64_t rest_ns_ = 0;
};

}  // namespace

ReplayReport replay(const PenRecord& record) { return Replay(record).run(); }

}  // namespace prismesh::drivers::haptics

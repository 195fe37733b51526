#include "daemon/deviced/pen/pen_loop.h"

#include <algorithm>
#include <utility>

namespace prismesh::deviced::pen {

namespace {

using drivers::haptic_pen::PenPhase;
using drivers::haptics::HapticAnswer;
using drivers::haptics::HapticTick;
using drivers::haptics::SafetyPhase;
using ipc::PenStage;

void store(std::array<double, 3>& to, const Eigen::Vector3d& from) { to = {from.x(), from.y(), from.z()}; }

PenStage stage_of(PenPhase device, SafetyPhase safety) {
  // A latch shows also while the device is away: it has to be known when it comes back.
  if (safety == SafetyPhase::latched) return PenStage::latched;
  switch (device) {
    case PenPhase::absent: return PenStage::absent;
    case PenPhase::setting_up: return PenStage::setting_up;
    case PenPhase::homing: return PenStage::homing;
    case PenPhase::ready: break;
  }
  return safety == SafetyPhase::armed ? PenStage::armed : PenStage::disarmed;
}

}  // namespace

PenLoop::PenLoop(const drivers::haptics::HapticLimits& limits, drivers::haptic_pen::HapticPen& pen, FieldReader& fields, GuardPage& guard,
                 ipc::PenPage& page, const drivers::haptics::SafetyRecord& stored, const drivers::haptics::Feel& feel,
                 std::uint64_t arms_answered)
    : pen_(pen), fields_(fields), guard_(guard), page_(page), loop_(limits, pen.limits(), stored), feel_(feel), stored_(stored) {
  drivers::haptics::PenRecordLimits used{loop_.max_newton(), {}};
  Eigen::Map<Eigen::Vector3d>(used.max_axis_newton) = pen.limits().max_axis_newton;
  page_.set_limits(used);
  record_.write(stored);
  state_.arms_answered = arms_answered;
}

void PenLoop::tick(std::int64_t now_ns) {
  HapticTick tick;
  tick.now_ns = now_ns;
  tick.pen = pen_.read(now_ns);
  take_commands(tick);
  tick.feel = feel_;
  if (const FieldCopy* copy = fields_.acquire()) {
    tick.sources.field = &copy->field;
    tick.sources.placement = copy->field.placement;
    if (copy->has_guides) tick.sources.guides = &copy->guides;
    if (copy->has_resistance) tick.sources.resistance = &copy->resistance;
  }
  // The guard has taken the line: the device has got zero, whatever this loop thinks it has sent.
  const bool tripped = guard_.is_tripped();
  if (tripped) tick.pen.trouble = drivers::haptic_pen::PenTrouble::io_error;
  const HapticAnswer answer = loop_.step(tick);
  // The guard gets the line back from a loop that sends zero, never from one that is armed.
  if (tripped && answer.safety.record.phase != SafetyPhase::armed) guard_.acknowledge();
  pen_.send(now_ns, answer.command);
  record_.write(answer.safety.record);
  publish(now_ns, tick, answer);
  keep(tick, answer);
  // A line that takes no zero is left to the guard, which has a way of its own.
  if (!pen_.is_stuck(now_ns)) guard_.beats.fetch_add(1);
}

void PenLoop::wind_down(std::int64_t now_ns) {
  (void)pen_.read(now_ns);
  guard_.acknowledge();
  pen_.send(now_ns, {Eigen::Vector3d::Zero(), now_ns});
  guard_.beats.fetch_add(1);
}

void PenLoop::take_commands(HapticTick& tick) {
  arming_ = false;
  while (const auto command = commands_.pop()) {
    if (std::holds_alternative<RequestArm>(*command)) arming_ = true;
    // To a safety a device that isn't ready for one tick is a pen that is put down.
    if (std::holds_alternative<RequestDisarm>(*command)) {
      arming_ = false;
      if (tick.pen.phase == PenPhase::ready) tick.pen.phase = PenPhase::setting_up;
    }
    if (const auto* use = std::get_if<UseFeel>(&*command)) feel_ = use->feel;
    if (arming_) break;  // one request is answered in each tick
  }
  tick.rearm = arming_;
}

void PenLoop::publish(std::int64_t now_ns, const HapticTick& tick, const HapticAnswer& answer) {
  state_.time_ns = now_ns;
  if (tick.pen.fresh) {
    state_.measured_ns = tick.pen.pose.measured_ns;
    store(state_.position_mm, tick.pen.pose.position_mm);
    state_.has_orientation = tick.pen.pose.has_orientation;
    const Eigen::Quaterniond& turn = tick.pen.pose.orientation;
    state_.orientation = {turn.w(), turn.x(), turn.y(), turn.z()};
  }
  state_.stage = stage_of(tick.pen.phase, answer.safety.record.phase);
  state_.fault = answer.safety.record.fault;
  state_.buttons = tick.pen.buttons;
  store(state_.newton, answer.command.newton);
  state_.touching = answer.contact.touching;
  state_.damping_only = answer.safety.damping_only;
  state_.tank_limited = answer.safety.tank_limited;
  store(state_.proxy_mm, answer.contact.proxy_mm);
  store(state_.normal, answer.contact.normal);
  state_.element = answer.contact.element;
  const HapticField* field = tick.sources.field;
  state_.field_number = field != nullptr ? field->number : 0;
  state_.field_generation = field != nullptr ? field->mesh_generation : 0;
  state_.field_ns = field != nullptr ? field->time_ns : 0;
  state_.round_trip_ns = pen_.round_trip_ns();
  if (arming_) {
    ++state_.arms_answered;
    state_.arm_refused = answer.safety.rearm_refused;
  }
  page_.set_state(state_);
}

/// After `publish`, which has the newest pose.
void PenLoop::keep(const HapticTick& tick, const HapticAnswer& answer) {
  const auto vector = [](double(&to)[3], const Eigen::Vector3d& from) { Eigen::Map<Eigen::Vector3d>{to} = from; };
  const auto flag = [](bool is) { return static_cast<std::uint8_t>(is); };
  drivers::haptics::PenTick kept{};
  kept.now_ns = tick.now_ns;
  std::copy(state_.position_mm.begin(), state_.position_mm.end(), kept.position_mm);
  kept.measured_ns = state_.measured_ns;
  for (std::size_t kind = 0; kind < answer.parts.size(); ++kind) {
    vector(kept.parts[kind].newton, answer.parts[kind].newton);
    kept.parts[kind].from_ns = answer.parts[kind].from_ns;
  }
  kept.lost_replies = tick.pen.lost_replies;
  kept.buttons = tick.pen.buttons;
  kept.element = answer.contact.element;
  kept.ready = flag(tick.pen.phase == PenPhase::ready);
  kept.io_error = flag(drivers::haptics::is_line_fault(tick.pen));
  kept.rearm = flag(tick.rearm);
  kept.begins = flag(std::exchange(begins_, false));
  kept.stored_phase = static_cast<std::uint8_t>(stored_.phase);
  kept.stored_fault = static_cast<std::uint8_t>(stored_.fault);
  kept.phase = static_cast<std::uint8_t>(answer.safety.record.phase);
  kept.fault = static_cast<std::uint8_t>(answer.safety.record.fault);
  kept.damping_only = flag(answer.safety.damping_only);
  kept.tank_limited = flag(answer.safety.tank_limited);
  kept.rearm_refused = flag(answer.safety.rearm_refused);
  vector(kept.newton, answer.command.newton);
  page_.add_tick(kept);
}

}  // namespace prismesh::deviced::pen

#include "drivers/haptics/haptic_loop.h"

#include <algorithm>
#include <cmath>

#include "drivers/haptics/stiffness.h"

namespace prismesh::drivers::haptics {
namespace {

/// Time constant of the velocity's filter: a step of the position's resolution shouldn't be felt.
constexpr double kVelocitySeconds = 0.003;

HapticLimits within(HapticLimits limits, const haptic_pen::PenLimits& device) {
  if (device.max_newton > 0) limits.max_newton = std::min(limits.max_newton, device.max_newton);
  return limits;
}

}  // namespace

bool is_line_fault(const haptic_pen::PenReading& pen) {
  return pen.trouble == haptic_pen::PenTrouble::io_error || pen.trouble == haptic_pen::PenTrouble::bad_reply;
}

HapticLoop::HapticLoop(const HapticLimits& limits, const haptic_pen::PenLimits& device, const SafetyRecord& stored)
    : max_stiffness_newton_m_(haptics::max_stiffness_newton_m(device, limits.period_ns)),
      max_newton_(within(limits, device).max_newton),
      safety_(within(limits, device), device.max_axis_newton, stored) {}

HapticAnswer HapticLoop::step(const HapticTick& tick) {
  HapticAnswer answer;
  take_pose(tick.pen);
  Feel feel = tick.feel;
  const HapticResistance* resistance = tick.sources.resistance;
  if (resistance != nullptr && resistance->placement != tick.sources.placement) resistance = nullptr;
  // The springs of contact and resistance may act in one direction: both together keep to the device's bound, the resistance to half of it.
  const double full_stretch_mm = std::max(kFullStretchMm, 2 * feel.max_resistance_newton / (max_stiffness_newton_m_ * 1e-3));
  const double resisting_newton_m = resisting_newton(resistance, feel.max_resistance_newton) / (full_stretch_mm * 1e-3);
  feel.stiffness_newton_m = answer.stiffness_newton_m = std::min(feel.stiffness_newton_m, max_stiffness_newton_m_ - resisting_newton_m);
  const HapticField* field = tick.sources.field;
  if (field != nullptr && field->placement != tick.sources.placement) field = nullptr;
  ForceSources sources = tick.sources;
  sources.field = field;
  if (pose_.measured_ns == 0) field = nullptr;
  answer.contact = proxy_.step(field, pose_.position_mm, feel.friction);
  // Without a force the pen passes through shells. Where it is clear of them by itself again, nothing holds it any more.
  if (answer.contact.touching && safety_.record().phase != SafetyPhase::armed) {
    Proxy at_pen;
    const ProxyContact free = at_pen.step(field, pose_.position_mm, feel.friction);
    if (free.attached) proxy_ = at_pen, answer.contact = free;
  }
  answer.parts = force_parts(motion_, answer.contact, sources, feel);
  if (resistance != nullptr)
    answer.parts[static_cast<std::size_t>(ForceKind::resistance)] = {
        resistance_.step(pose_.position_mm, pose_.measured_ns != 0 ? resistance : nullptr, feel.max_resistance_newton, full_stretch_mm),
        resistance->time_ns, false};
  else
    resistance_.let_go();

  SafetyInput input;
  input.now_ns = tick.now_ns;
  input.position_mm = pose_.position_mm;
  input.measured_ns = pose_.measured_ns;
  input.ready = tick.pen.phase == haptic_pen::PenPhase::ready;
  input.io_error = is_line_fault(tick.pen);
  input.lost_replies = tick.pen.lost_replies;
  input.parts = answer.parts;
  input.rearm = tick.rearm;
  answer.safety = safety_.step(input);
  answer.command = {answer.safety.newton, answer.safety.valid_until_ns};
  return answer;
}

void HapticLoop::take_pose(const haptic_pen::PenReading& pen) {
  if (!pen.fresh) return;
  const double seconds = static_cast<double>(pen.pose.measured_ns - pose_.measured_ns) * 1e-9;
  if (pose_.measured_ns == 0 || !(seconds > 0) || !pen.pose.position_mm.allFinite() || !pose_.position_mm.allFinite()) {
    motion_.velocity_mm_s.setZero();
  } else {
    const Eigen::Vector3d velocity = (pen.pose.position_mm - pose_.position_mm) / seconds;
    motion_.velocity_mm_s += (velocity - motion_.velocity_mm_s) * (seconds / (seconds + kVelocitySeconds));
  }
  pose_ = pen.pose;
  motion_.position_mm = pose_.position_mm;
}

}  // namespace prismesh::drivers::haptics

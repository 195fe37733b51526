#include "drivers/haptic_pen/inverse3/inverse3_pen.h"

#include "drivers/haptic_pen/device_limits.h"
#include "drivers/haptic_pen/inverse3/messages.h"

namespace prismesh::drivers::haptic_pen::inverse3 {
namespace {

/// From a pose to the force that answers it, without the period: two ways through the service and its device. A guess.
constexpr std::int64_t kInverse3DelayNs = 2'000'000;
constexpr std::int64_t kUnhandledNs = 10'000'000;

}  // namespace

PenLimits inverse3_limits(const Inverse3Options& options) {
  return limits_of(kInverse3Figures, options.damping_newton_s_m, options.friction_newton, kInverse3DelayNs);
}

PenReading Inverse3Pen::read(std::int64_t /*now_ns*/) {
  PenReading reading;
  while (const auto answer = link_.take()) {
    ++reading.replies;
    answered_ = true;
    ready_ = answer->ready;
    buttons_ = answer->buttons;
    round_trip_ns_ = answer->answered_ns - answer->asked_ns;
    if (!answer->has_position || !answer->ready) continue;
    reading.fresh = true;
    reading.pose.measured_ns = answer->asked_ns + round_trip_ns_ / 2;
    const Eigen::Vector3d place_m = Eigen::Map<const Eigen::Vector3d>(answer->position_m.data()) - workspace_middle_m();
    reading.pose.position_mm = to_pen_axes(place_m) * 1e3;
    reading.pose.has_orientation = answer->has_orientation;
    const auto& [w, x, y, z] = answer->orientation;
    reading.pose.orientation = to_pen_axes(Eigen::Quaterniond(w, x, y, z));
  }
  const LinkEnd end = link_.end();
  reading.phase = end != LinkEnd::none ? PenPhase::absent : ready_ ? PenPhase::ready : PenPhase::setting_up;
  if (end != LinkEnd::none) reading.trouble = end == LinkEnd::bad_reply ? PenTrouble::bad_reply : PenTrouble::io_error;
  reading.buttons = buttons_;
  return reading;
}

void Inverse3Pen::send(std::int64_t now_ns, const PenCommand& command) {
  if (gone()) return;
  PenCommand bounded;
  if (ready_) {
    bounded = command;
    bounded.newton /= options_.force_scale;
    bounded = within(bounded, limits_);
  }
  LinkForce force;
  Eigen::Map<Eigen::Vector3d>(force.newton.data()) = to_service_axes(bounded.newton);
  force.asked_ns = now_ns;
  force.valid_until_ns = command.valid_until_ns;
  // Where the ring is full the thread handles nothing, and `is_stuck` sees that.
  if (link_.put(force)) ++put_;
}

bool Inverse3Pen::is_stuck(std::int64_t now_ns) {
  const std::uint64_t handled = link_.handled();
  if (handled == put_ || handled != handled_ || gone()) moved_ns_ = now_ns;
  handled_ = handled;
  return now_ns - moved_ns_ > kUnhandledNs;
}

std::string Inverse3Pen::advice() const {
  if (answered_ && !ready_ && !gone()) return "the service says that the Inverse3 isn't ready: see its light and Haply's Hub";
  return {};
}

}  // namespace prismesh::drivers::haptic_pen::inverse3

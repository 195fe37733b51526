#include "drivers/haptic_pen/falcon/falcon_pen.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "drivers/haptic_pen/device_limits.h"
#include "drivers/haptic_pen/falcon/ftdi.h"

namespace prismesh::drivers::haptic_pen::falcon {
namespace {

/// So many questions may be without an answer before the next waits: a queue would make each pose old. A zero after a force doesn't wait.
constexpr std::size_t kMaxAsked = 3;
/// A question that old isn't answered any more.
constexpr std::int64_t kAnswerNs = 20'000'000;
/// Then nothing is asked for so long: an answer that comes after all would be taken for that of a later question.
constexpr std::int64_t kStuckNs = 10'000'000;
constexpr std::int64_t kResyncNs = 25'000'000;
/// From a pose to the force that answers it, without the period: the chip's latency of 1 ms and two frames of the bus.
constexpr std::int64_t kDelayNs = 1'500'000;

std::string fault_words(BootFault fault) {
  switch (fault) {
    case BootFault::none: break;
    case BootFault::needs_firmware:
      return "the Falcon runs no firmware, and none is given: set haptic_pen.firmware to its file (docs/devices/haptic-pen.md)";
    case BootFault::no_greeting: return "the Falcon doesn't answer: is its power supply plugged in?";
    case BootFault::no_loader: return "the Falcon's boot loader doesn't answer: unplug its power for ten seconds";
    case BootFault::no_echo:
      return "the Falcon stopped taking the firmware: unplug its power for ten seconds; if that doesn't help, get the firmware file anew";
    case BootFault::wrong_echo: return "the Falcon got the firmware with errors: try another cable or USB socket";
    case BootFault::no_start: return "the Falcon took the firmware, but it doesn't run: is the file one for a Falcon?";
  }
  return {};
}

}  // namespace

port::UsbWanted falcon_wanted() {
  port::UsbWanted wanted;
  wanted.vendor = 0x0403;
  wanted.product = 0xCB48;
  wanted.name = "Novint Falcon";
  wanted.product_text = "FALCON HAPTIC";
  return wanted;
}

PenLimits falcon_limits(const FalconOptions& options) {
  return limits_of(kFalconFigures, options.damping_newton_s_m, options.friction_newton, kDelayNs);
}

PacketBytes zero_packet() { return encode(ForcePacket{}); }

FalconPen::FalconPen(port::UsbPort& port, FalconOptions options)
    : port_(port), options_(std::move(options)), limits_(falcon_limits(options_)), boot_(port_, options_.firmware) {}

PenReading FalconPen::read(std::int64_t now_ns) {
  PenReading reading;
  const BootPhase boot = boot_.progress().phase.load() == BootPhase::running ? BootPhase::running : boot_.step(now_ns);
  if (boot == BootPhase::running && !answered_) {
    // Its boot has read all answers.
    answered_ = true;
    finder_.clear();
  } else if (boot == BootPhase::running) {
    const std::uint64_t skipped = finder_.skipped();
    std::array<std::byte, port::kUsbPacketBytes> packet{};
    // What is left then is read in the next tick.
    for (std::size_t turn = 0; turn < port::kUsbPackets; ++turn) {
      const port::PortCount got = port_.read(packet);
      if (got.bytes == 0) break;
      for (std::size_t at = ftdi::kStatusBytes; at < got.bytes; ++at) {
        const auto bytes = finder_.take(packet[at]);
        if (!bytes) continue;
        if (const auto pose = decode_pose(*bytes))
          take(*pose, now_ns, reading);
        else
          reading.trouble = PenTrouble::bad_reply;
      }
    }
    // Before the first answer there may be the end of an older one.
    if (round_trip_ns_ > 0 && finder_.skipped() != skipped) reading.trouble = PenTrouble::bad_reply;
    if (asked_count_ > 0 && now_ns - asked_ns_[asked_begin_] > kAnswerNs) {
      reading.lost_replies = static_cast<std::uint32_t>(asked_count_);
      asked_count_ = 0;
      resync_until_ns_ = now_ns + kResyncNs;
    }
  }
  if (port_.last_error() != 0) gone_ = true;
  const bool homed = homed_.load() == kAllHomed;
  reading.phase = gone_ ? PenPhase::absent : boot != BootPhase::running ? PenPhase::setting_up : homed ? PenPhase::ready : PenPhase::homing;
  if (boot == BootPhase::failed) reading.trouble = PenTrouble::refused;
  if (gone_ || std::exchange(refused_, false)) reading.trouble = PenTrouble::io_error;
  reading.buttons = buttons_;
  return reading;
}

void FalconPen::take(const PosePacket& packet, std::int64_t now_ns, PenReading& reading) {
  // An answer to nobody's question is an old one.
  if (asked_count_ == 0) return;
  const std::int64_t asked_ns = asked_ns_[asked_begin_];
  asked_begin_ = (asked_begin_ + 1) % asked_ns_.size();
  --asked_count_;
  ++reading.replies;
  round_trip_ns_ = now_ns - asked_ns;
  buttons_ = packet.buttons;
  const bool was_homed = homed_.exchange(packet.homed) == kAllHomed;
  if (packet.homed != kAllHomed) {
    placed_ = false;
    return;
  }
  // Homing moves the origin of the encoders: what was before has nothing to do with this place.
  const Eigen::Vector3d near = was_homed && placed_ ? place_.position : kMiddle;
  Eigen::Vector3d angles;
  for (Eigen::Index arm = 0; arm < 3; ++arm) angles[arm] = angle_of_count(packet.encoders[static_cast<std::size_t>(arm)]);
  const auto place = forward_kinematics(angles, near);
  placed_ = place.has_value();
  if (!place) {
    reading.trouble = PenTrouble::bad_reply;
    return;
  }
  place_ = *place;
  reading.fresh = true;
  reading.pose.measured_ns = asked_ns + (now_ns - asked_ns) / 2;
  reading.pose.position_mm = (place_.position - kMiddle) * 1e3;
}

void FalconPen::send(std::int64_t now_ns, const PenCommand& command) {
  if (gone_ || !answered_) return;
  ForcePacket packet;
  const bool homed = homed_.load() == kAllHomed;
  if (homed && placed_) packet.motors = motor_units(command.newton);
  const bool zero = packet.motors == std::array<std::int16_t, 3>{};
  packet.lights = !homed ? kRed : zero ? kGreen : kBlue;
  const bool ends_force = zero && sent_force_;
  const bool resyncs = now_ns < resync_until_ns_;
  const bool waits = resyncs || asked_count_ >= kMaxAsked || port_.pending() >= kMaxAsked;
  if (asked_count_ == asked_ns_.size() || (waits && !ends_force)) return;
  // A zero is never too old.
  const port::PortStatus put = port_.write(encode(packet), zero ? port::kUsbForever : command.valid_until_ns);
  if (put != port::PortStatus::ok) {
    gone_ = put == port::PortStatus::gone;
    refused_ = true;
    return;
  }
  sent_force_ = !zero;
  if (resyncs) return;
  asked_ns_[(asked_begin_ + asked_count_++) % asked_ns_.size()] = now_ns;
}

std::array<std::int16_t, 3> FalconPen::motor_units(const Eigen::Vector3d& newton) const {
  if (!newton.allFinite()) return {};
  Eigen::Vector3d units = -torques(place_, newton) * (kUnitsPerNewtonMetre / options_.force_scale);
  // All motors by the same share, so that the direction stays.
  if (const double largest = units.cwiseAbs().maxCoeff(); largest > kMaxUnits) units *= kMaxUnits / largest;
  if (!units.allFinite()) return {};
  std::array<std::int16_t, 3> motors{};
  for (std::size_t arm = 0; arm < 3; ++arm) motors[arm] = static_cast<std::int16_t>(std::trunc(units[static_cast<Eigen::Index>(arm)]));
  return motors;
}

bool FalconPen::is_stuck(std::int64_t now_ns) {
  // While it boots a request may take long.
  const std::uint64_t finished = port_.finished();
  if (!answered_ || port_.pending() == 0 || finished != finished_) moved_ns_ = now_ns;
  finished_ = finished;
  return now_ns - moved_ns_ > kStuckNs;
}

std::string FalconPen::advice() const {
  const BootProgress& boot = boot_.progress();
  const std::string fault = fault_words(boot.fault.load());
  switch (boot.phase.load()) {
    case BootPhase::failed: return fault;
    case BootPhase::running: break;
    case BootPhase::working:
      if (boot.loading) return fmt::format("the firmware is being loaded: {} %", boot.percent.load());
      return fault.empty() ? std::string("the Falcon is being started")
                           : fmt::format("{} (attempt {} of {})", fault, boot.attempt.load(), kBootAttempts);
  }
  const unsigned homed = homed_.load();
  if (homed == kAllHomed) return {};
  std::string missing;
  for (const auto& [bit, name] : {std::pair{1u, "top"}, {2u, "right"}, {4u, "left"}})
    if ((homed & bit) == 0) missing += (missing.empty() ? "" : ", ") + std::string(name);
  return "home it by hand: pull the grip all the way out, then push it all the way in (arms to go: " + missing + ")";
}

}  // namespace prismesh::drivers::haptic_pen::falcon

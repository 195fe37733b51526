#include "daemon/deviced/device_status.h"

#include "drivers/prism_servo/dynamixel/servo.h"

namespace prismesh::deviced {

namespace {

using drivers::prism_servo::MaskPhase;
using drivers::prism_servo::ServoPhase;
using drivers::settings::EyeTrackerSettings;
using drivers::settings::PrismServoSettings;
using drivers::settings::TrackerDriver;
using ipc::EyesPhase;

std::string not_open(const drivers::port::KeeperReport& port) { return port.reason ? port.reason->text() : std::string(); }

std::string silence_of(const EyeTrackerSettings& settings) {
  if (settings.driver == TrackerDriver::opentrack)
    return "no head poses arrive at UDP port " + std::to_string(settings.udp_port) +
           ": start opentrack and let its output \"UDP over network\" send to 127.0.0.1, port " + std::to_string(settings.udp_port);
  return settings.port + " is open, but no tracker's records come from it at " + std::to_string(settings.baud) +
         " baud: is the tracker switched on, and are port, baud and dialect in prismesh.toml those of this tracker?";
}

std::string trouble_of(const PrismServoSettings& settings, const ServoStatus& status, const drivers::port::KeeperReport& port) {
  constexpr const char* kRearm = "then say so with `prismesh devices --rearm`";
  if (!status.open) return not_open(port);
  const std::string of_servo = drivers::prism_servo::dynamixel::trouble_text(status.tick, settings);
  if (status.mask == MaskPhase::alarm)
    return (of_servo.empty() ? std::string("the motor has switched itself off: find out why") : of_servo) + ", " + kRearm;
  if (!of_servo.empty()) return of_servo;
  if (status.mask == MaskPhase::stuck)
    return std::string(
               "the mask doesn't go where it is told, so the motor's torque was switched off: look what blocks it or has come loose, ") +
           kRearm;
  return {};
}

}  // namespace

std::string_view name(MaskPhase phase) {
  switch (phase) {
    case MaskPhase::absent: return "absent";
    case MaskPhase::homing: return "homing";
    case MaskPhase::following: return "following";
    case MaskPhase::flying_back: return "flying back";
    case MaskPhase::frozen: return "frozen";
    case MaskPhase::parking: return "parking";
    case MaskPhase::parked: return "parked";
    case MaskPhase::held: return "held";
    case MaskPhase::stuck: return "stuck";
    case MaskPhase::alarm: return "alarm";
  }
  return "unknown";
}

ipc::DeviceInfo tracker_info(const EyeTrackerSettings& settings, const TrackerStatus& status, const drivers::port::KeeperReport& port) {
  const bool datagrams = settings.driver == TrackerDriver::opentrack;
  ipc::DeviceInfo info;
  info.role = "eye tracker";
  info.kind = datagrams ? "opentrack" : "dynasight";
  info.where = datagrams ? "127.0.0.1:" + std::to_string(settings.udp_port) : settings.port;
  info.simulated = settings.simulated;
  info.state = name(status.phase);
  if (status.phase == EyesPhase::absent) info.trouble = not_open(port);
  if (status.phase == EyesPhase::silent && status.age_ns > kMaxFirstSilenceNs) info.trouble = silence_of(settings);
  return info;
}

ipc::DeviceInfo servo_info(const PrismServoSettings& settings, const ServoStatus& status, const drivers::port::KeeperReport& port) {
  ipc::DeviceInfo info;
  info.role = "prism servo";
  info.kind = "dynamixel";
  info.where = settings.port;
  info.simulated = settings.simulated;
  info.state = name(status.mask);
  info.trouble = trouble_of(settings, status, port);
  return info;
}

}  // namespace prismesh::deviced

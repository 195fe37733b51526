// The devices in words that a user can act on.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "drivers/port/port_keeper.h"
#include "drivers/prism_servo/mask_control.h"
#include "drivers/prism_servo/prism_servo.h"
#include "drivers/settings/settings.h"
#include "ipc/device_messages.h"
#include "ipc/device_page.h"

namespace prismesh::deviced {

std::string_view name(drivers::prism_servo::MaskPhase phase);

/// A device that has just been opened says nothing yet; that is a trouble only after so long.
inline constexpr std::int64_t kFirstWordNs = 1'500'000'000;

struct TrackerStatus {
  ipc::EyesPhase phase = ipc::EyesPhase::none;
  std::int64_t age_ns = 0;  ///< how long it has been in that phase
};
/// The settings' port is the pseudo-terminal where the device is simulated.
ipc::DeviceInfo tracker_info(const drivers::settings::EyeTrackerSettings& settings, const TrackerStatus& status,
                             const drivers::port::KeeperReport& port);

struct ServoStatus {
  drivers::prism_servo::MaskPhase mask = drivers::prism_servo::MaskPhase::absent;
  bool open = false;  ///< its port
  drivers::prism_servo::PrismServo::Tick tick;
};
ipc::DeviceInfo servo_info(const drivers::settings::PrismServoSettings& settings, const ServoStatus& status,
                           const drivers::port::KeeperReport& port);

}  // namespace prismesh::deviced

// The devices in words that a user can act on.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "drivers/port/port_keeper.h"
#include "drivers/prism_servo/mask_control.h"
#include "drivers/prism_servo/prism_servo.h"
#include "drivers/settings/settings.h"
#include "ipc/device_messages.h"
#include "ipc/device_page.h"

namespace prismesh::deviced {

std::string_view name(ipc::EyesPhase phase);
std::string_view name(drivers::prism_servo::MaskPhase phase);

/// `port` is what the settings say, or the pseudo-terminal of a simulated device.
ipc::DeviceInfo tracker_info(const drivers::settings::EyeTrackerSettings& settings, ipc::EyesPhase phase,
                             const drivers::port::KeeperReport& port);

struct ServoStatus {
  drivers::prism_servo::MaskPhase mask = drivers::prism_servo::MaskPhase::absent;
  bool open = false;  ///< its port
  drivers::prism_servo::PrismServo::Tick tick;
};
ipc::DeviceInfo servo_info(const drivers::settings::PrismServoSettings& settings, const ServoStatus& status,
                           const drivers::port::KeeperReport& port);

}  // namespace prismesh::deviced

// Describes the devices' status in sentences that a user can act on.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "drivers/port/port_keeper.h"
#include "drivers/prism_servo/mask_control.h"
#include "drivers/prism_servo/prism_servo.h"
#include "drivers/settings/settings.h"
#include "ipc/device/messages.h"
#include "ipc/device/page.h"

namespace prismesh::deviced {

std::string_view name(drivers::prism_servo::MaskPhase phase);

/// A silent device counts as trouble only so long after its port was opened.
inline constexpr std::int64_t kMaxFirstSilenceNs = 1'500'000'000;

struct TrackerStatus {
  ipc::EyesPhase phase = ipc::EyesPhase::none;
  std::int64_t age_ns = 0;  ///< time since the phase began
};
/// For a simulated device, `settings` names the pseudo-terminal as its port.
ipc::DeviceInfo tracker_info(const drivers::settings::EyeTrackerSettings& settings, const TrackerStatus& status,
                             const drivers::port::KeeperReport& port);

struct ServoStatus {
  drivers::prism_servo::MaskPhase mask = drivers::prism_servo::MaskPhase::absent;
  bool open = false;  ///< the servo's port is open
  drivers::prism_servo::PrismServo::Tick tick;
};
ipc::DeviceInfo servo_info(const drivers::settings::PrismServoSettings& settings, const ServoStatus& status,
                           const drivers::port::KeeperReport& port);

}  // namespace prismesh::deviced

// The devices that the settings name: starts simulators where asked for, keeps the ports open, runs the device loop, and watches that it
// ticks.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "base/error.h"
#include "daemon/common/watchdog.h"
#include "daemon/deviced/device_status.h"
#include "daemon/deviced/loop.h"
#include "drivers/display/profile.h"
#include "drivers/settings/settings.h"
#include "ipc/device/page.h"

namespace prismesh::deviced {

/// The checked settings of a station.
struct StationPlan {
  drivers::settings::StationSettings settings;
  drivers::display::Profile profile;
  drivers::prism_servo::dynamixel::ServoSettings servo;

  bool has_tracker() const { return settings.eye_tracker.driver != drivers::settings::TrackerDriver::none; }
  /// A servo is used only if the display has a moving mask.
  bool has_servo() const { return settings.prism_servo.driver != drivers::settings::ServoDriver::none && profile.mask_moves; }
  double eye_separation_mm() const { return profile.eye_separation_mm.value_or(settings.eye_tracker.eye_separation_mm); }
  /// Whether a running station of the other plan can switch to this one by SetDisplay alone.
  bool same_devices(const StationPlan& other) const;
};

/// Reads prismesh.toml and the profile it names. Errors: of both; settings that no servo supports.
Result<StationPlan> read_plan(const std::optional<std::filesystem::path>& config);

/// Returns the device loop's settings for a plan.
LoopSettings loop_settings(const StationPlan& plan);

class Station {
 public:
  /// `stuck` is called once, from the station's own thread, when the loop has stopped ticking. `page` must outlive the station. Errors: no
  /// pseudo-terminal for a simulated device; no thread can be created.
  static Result<std::unique_ptr<Station>> start(const StationPlan& plan, ipc::DevicePage& page, bool memory_locked,
                                                std::function<void()> stuck);
  /// Switches the motor's torque off and closes the ports.
  ~Station();
  Station(const Station&) = delete;
  Station& operator=(const Station&) = delete;

  // This and all that follows: called from one thread.
  bool send(const LoopCommand& command);
  /// Reads the loop's events and returns the status of each device.
  std::vector<ipc::DeviceInfo> poll();
  const daemon::Heartbeat& heartbeat() const;  ///< of the loop
  const std::string& refused() const;          ///< as LoopThread::refused

 private:
  struct Impl;
  explicit Station(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace prismesh::deviced

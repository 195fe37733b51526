// The devices that the settings name, at work: simulators where they are asked for, ports kept open, the loop ticking, and somebody
// who watches that it does.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "base/error.h"
#include "daemon/deviced/loop.h"
#include "daemon/deviced/words.h"
#include "drivers/display/profile.h"
#include "drivers/settings/settings.h"
#include "ipc/device_page.h"

namespace prismesh::deviced {

/// What a station is made of, as read and found to be sound.
struct StationPlan {
  drivers::settings::Settings settings;
  drivers::display::Profile profile;
  drivers::prism_servo::dynamixel::ServoSettings servo;

  bool has_tracker() const { return settings.eye_tracker.driver != drivers::settings::TrackerDriver::none; }
  /// A servo whose display has no mask to be moved is left alone.
  bool has_servo() const { return settings.prism_servo.driver != drivers::settings::ServoDriver::none && profile.mask_moves; }
  double eye_separation_mm() const { return profile.eye_separation_mm.value_or(settings.eye_tracker.eye_separation_mm); }
  /// Whether a station of the other plan can go on with this one by taking SetDisplay.
  bool same_devices(const StationPlan& other) const;
};

/// Reads prismesh.toml and the profile it names. Errors: theirs, and settings that no servo can have.
Result<StationPlan> read_plan(const std::optional<std::filesystem::path>& config);

/// What the plan means for the loop.
LoopSettings loop_settings(const StationPlan& plan);

class Station {
 public:
  /// `stuck` is called from a thread of the station's own, once, when the loop has stopped ticking. `page` outlives the station.
  /// Errors: no pseudo-terminal for a simulated device, no thread.
  static Result<std::unique_ptr<Station>> start(const StationPlan& plan, ipc::DevicePage& page, bool memory_locked,
                                                std::function<void()> stuck);
  /// The motor is let go, the ports are closed.
  ~Station();
  Station(const Station&) = delete;
  Station& operator=(const Station&) = delete;

  // From one thread, as all that follows.
  bool tell(const LoopCommand& command);
  /// Takes in what the loop has told, and says how each device is.
  std::vector<ipc::DeviceInfo> look();
  const std::string& refused() const;  ///< of LoopThread

 private:
  struct State;
  explicit Station(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace prismesh::deviced

// The device loop: reads the eye tracker, filters the head position, moves the mask after the eyes, and publishes eyes and mask. Time,
// ports and page are passed in. A tick doesn't allocate, lock, log or block. Events for the main thread go into one ring, commands from it
// come through another.
#pragma once

#include <cstdint>
#include <optional>
#include <variant>

#include "base/ring.h"
#include "drivers/display/optics.h"
#include "drivers/eye_tracker/configured/tracker.h"
#include "drivers/eye_tracker/filter.h"
#include "drivers/port/port_keeper.h"
#include "drivers/prism_servo/dynamixel/servo.h"
#include "drivers/prism_servo/mask_control.h"
#include "drivers/settings/settings.h"
#include "ipc/device/page.h"

namespace prismesh::deviced {

inline constexpr std::int64_t kTickPeriodNs = 4'000'000;

/// The loop's ports; null where a device is missing. The keepers must outlive the loop.
struct LoopPorts {
  drivers::port::PortKeeper* tracker_line = nullptr;
  drivers::port::DatagramKeeper* tracker_datagrams = nullptr;
  drivers::port::PortKeeper* servo_line = nullptr;
};

struct LoopSettings {
  drivers::settings::EyeTrackerSettings tracker;
  drivers::prism_servo::dynamixel::ServoSettings servo;
  drivers::display::MaskOptics optics;
  drivers::prism_servo::MaskLimits limits;  ///< after `eyes_lost_ns` without a head the tracker counts as searching, too
  double eye_separation_mm = drivers::display::kMeanEyeSeparationMm;
};

// Commands from the main thread to the loop.
struct SetPictureMono {
  bool mono = true;
};
struct SetHold {
  double position_mm = 0;
};
struct EndHold {};
struct RequestRearm {};
struct SetDisplay {
  drivers::display::MaskOptics optics;
  double eye_separation_mm = drivers::display::kMeanEyeSeparationMm;
};
using LoopCommand = std::variant<SetPictureMono, SetHold, EndHold, RequestRearm, SetDisplay>;

// Events from the loop to the main thread: changes only, so that a fault is reported once.
struct EyesChanged {
  std::int64_t time_ns = 0;
  ipc::EyesPhase phase = ipc::EyesPhase::none;
};
struct MaskChanged {
  std::int64_t time_ns = 0;
  drivers::prism_servo::MaskPhase phase = drivers::prism_servo::MaskPhase::absent;
};
struct ServoChanged {
  std::int64_t time_ns = 0;
  bool open = false;  ///< the servo's port is open
  drivers::prism_servo::PrismServo::Tick tick;
};
using LoopEvent = std::variant<EyesChanged, MaskChanged, ServoChanged>;

class DeviceLoop {
 public:
  DeviceLoop(const LoopSettings& settings, const LoopPorts& ports, ipc::DevicePage& page);

  /// Called once a period. Writes the page's slots for eyes and prism; the caller writes the health slot.
  void tick(std::int64_t now_ns);
  /// Called instead of `tick` before the loop ends: switches the motor's torque off and publishes that eyes and mask are unknown. Call it
  /// for several periods, so that the servo receives the command.
  void wind_down(std::int64_t now_ns);

  // Called from one other thread.
  /// Returns false if the ring is full.
  bool send(const LoopCommand& command) { return commands_.push(command); }
  std::optional<LoopEvent> next_event() { return events_.pop(); }

 private:
  using Tracker = drivers::eye_tracker::EyeTracker;
  using Servo = drivers::prism_servo::dynamixel::Servo;

  void take_commands();
  void execute(const LoopCommand& command);
  Tracker* attached_tracker();
  void release_tracker();
  void poll_tracker(std::int64_t now_ns);
  ipc::EyesPhase eyes_phase(std::int64_t now_ns);
  void publish_eyes(std::int64_t now_ns);
  void tick_servo(std::int64_t now_ns, double goal_mm, bool powered);
  void publish_mask(std::int64_t now_ns);
  void report_changes(std::int64_t now_ns);

  LoopSettings settings_;
  LoopPorts ports_;
  ipc::DevicePage& page_;
  Ring<LoopCommand, 64> commands_;
  Ring<LoopEvent, 256> events_;

  drivers::eye_tracker::configured::ConfiguredTracker tracker_;
  drivers::eye_tracker::HeadFilter filter_;
  ipc::EyesState eyes_;
  std::optional<Servo> servo_;
  drivers::prism_servo::PrismServo::Tick servo_tick_;
  drivers::prism_servo::MaskControl control_;
  drivers::prism_servo::MaskControl::Output mask_;
  bool picture_mono_ = true;
  std::optional<double> hold_mm_;
  bool rearm_ = false;

  ipc::EyesPhase reported_eyes_ = ipc::EyesPhase::none;
  drivers::prism_servo::MaskPhase reported_mask_ = drivers::prism_servo::MaskPhase::absent;
  ServoChanged reported_servo_;
};

}  // namespace prismesh::deviced

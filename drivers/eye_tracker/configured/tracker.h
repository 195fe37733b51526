// The eye tracker that a station's settings name, while its port is open. The real-time loop attaches and detaches ports
// (port/port_keeper.h), so neither allocates.
#pragma once

#include <cstdint>
#include <variant>

#include "drivers/eye_tracker/dynasight/tracker.h"
#include "drivers/eye_tracker/eye_tracker.h"
#include "drivers/eye_tracker/opentrack/tracker.h"
#include "drivers/port/udp_port.h"
#include "drivers/settings/settings.h"

namespace prismesh::drivers::eye_tracker::configured {

/// Convert the settings to a driver's options.
dynasight::DynasightTracker::Options dynasight_options(const settings::EyeTrackerSettings& settings);
opentrack::OpentrackTracker::Options opentrack_options(const settings::EyeTrackerSettings& settings);

class ConfiguredTracker {
 public:
  explicit ConfiguredTracker(const settings::EyeTrackerSettings& settings);

  /// Creates a new tracker on the port, with its counts at zero. The port must outlive it: call `detach` before you give the port back. The
  /// port's type must match the settings' driver: dynasight reads bytes, opentrack datagrams.
  EyeTracker& attach(port::BytePort& port);
  EyeTracker& attach(port::DatagramPort& port);
  void detach();
  /// Returns null while no port is attached.
  EyeTracker* tracker();

 private:
  dynasight::DynasightTracker::Options dynasight_;
  opentrack::OpentrackTracker::Options opentrack_;
  std::variant<std::monostate, dynasight::DynasightTracker, opentrack::OpentrackTracker> tracker_;
};

}  // namespace prismesh::drivers::eye_tracker::configured

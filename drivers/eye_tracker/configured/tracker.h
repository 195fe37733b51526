// The eye tracker that a station's settings name, while its port is there. Ports come and go in the real-time loop
// (port/port_keeper.h), so attaching to a port and detaching from it doesn't allocate.
#pragma once

#include <cstdint>
#include <variant>

#include "drivers/eye_tracker/dynasight/tracker.h"
#include "drivers/eye_tracker/eye_tracker.h"
#include "drivers/eye_tracker/opentrack/tracker.h"
#include "drivers/port/udp_port.h"
#include "drivers/settings/settings.h"

namespace prismesh::drivers::eye_tracker::configured {

/// Milliseconds to nanoseconds and the like: a driver's options from the settings.
dynasight::DynasightTracker::Options dynasight_options(const settings::EyeTrackerSettings& settings);
opentrack::OpentrackTracker::Options opentrack_options(const settings::EyeTrackerSettings& settings);

class ConfiguredTracker {
 public:
  explicit ConfiguredTracker(const settings::EyeTrackerSettings& settings);

  /// A new tracker on that port, its counts at zero. The port must outlive it: `detach` before giving the port back. The settings' driver
  /// must be of the port's kind: dynasight reads bytes, opentrack datagrams.
  EyeTracker& attach(port::BytePort& port);
  EyeTracker& attach(port::DatagramPort& port);
  void detach();
  /// Null while there is no port.
  EyeTracker* tracker();

 private:
  dynasight::DynasightTracker::Options dynasight_;
  opentrack::OpentrackTracker::Options opentrack_;
  std::variant<std::monostate, dynasight::DynasightTracker, opentrack::OpentrackTracker> tracker_;
};

}  // namespace prismesh::drivers::eye_tracker::configured

// Simulates an eye tracker for stations without one: a thread acts as the device over a pseudo-terminal (DynaSight, D4D) or loopback
// datagrams (opentrack). The daemon opens and reads it like the real device.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <thread>

#include "base/clock.h"
#include "base/error.h"
#include "drivers/eye_tracker/simulated_head.h"
#include "drivers/settings/settings.h"

namespace prismesh::drivers::eye_tracker::configured {

class SimulatedTrackerThread {
 public:
  /// Starts the simulation of the tracker that `settings` describe (driver, dialect, baud, latency, noise, offset, motion). `clock` must be
  /// CLOCK_MONOTONIC and outlive this. Errors: unknown motion; no pseudo-terminal available; driver `none`.
  static Result<std::unique_ptr<SimulatedTrackerThread>> start(const settings::EyeTrackerSettings& settings, Clock& clock,
                                                               std::uint64_t seed = 1);
  ~SimulatedTrackerThread();
  SimulatedTrackerThread(const SimulatedTrackerThread&) = delete;
  SimulatedTrackerThread& operator=(const SimulatedTrackerThread&) = delete;

  /// Returns the pseudo-terminal to open instead of the settings' port; empty for opentrack, which sends to the settings' udp_port.
  const std::string& port_path() const { return port_path_; }

 private:
  SimulatedTrackerThread() = default;
  struct Device;
  std::unique_ptr<Device> device_;
  std::string port_path_;
  std::jthread thread_;
};

}  // namespace prismesh::drivers::eye_tracker::configured

// The device's side of a line of frames: the simulated pen in real or virtual time, behind any port.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <thread>

#include "base/clock.h"
#include "drivers/haptic_pen/framed/frame.h"
#include "drivers/haptic_pen/simulated_pen.h"
#include "drivers/port/byte_port.h"

namespace prismesh::drivers::haptic_pen::framed {

/// Called for each force frame that arrives.
using ForceWatcher = std::function<void(std::int64_t now_ns, const ForceFrame& frame)>;

class SimulatedDevice {
 public:
  SimulatedDevice(port::BytePort& line, const SimulatedPenOptions& options, HandSource hand, ForceWatcher watcher = {});
  /// Call it at least once a millisecond: takes forces, moves the pen, sends a pose for each millisecond that began.
  void step(std::int64_t now_ns);
  const SimulatedPen& pen() const { return pen_; }

 private:
  port::BytePort& line_;
  SimulatedPen pen_;
  ForceWatcher watcher_;
  FrameFinder finder_;
  double quantum_mm_;
  std::int64_t pose_due_ns_ = 0;
  std::uint8_t number_ = 0, answers_ = 0;
};

/// What a FramedPen before such a device has to know.
PenLimits simulated_limits(const SimulatedPenOptions& options);

/// A hand that moves the pen slowly through its workspace, for demonstrations.
SimulatedHand wandering_hand(double seconds);

/// Runs the device in real time. Destroying it together with the port simulates an unplug.
class SimulatedDeviceThread {
 public:
  SimulatedDeviceThread(std::unique_ptr<port::BytePort> device_end, const SimulatedPenOptions& options, HandSource hand,
                        ForceWatcher watcher = {});
  ~SimulatedDeviceThread() = default;
  SimulatedDeviceThread(const SimulatedDeviceThread&) = delete;
  SimulatedDeviceThread& operator=(const SimulatedDeviceThread&) = delete;

 private:
  void run(const std::stop_token& stop);

  std::unique_ptr<port::BytePort> port_;
  SimulatedDevice device_;
  MonotonicClock clock_;
  std::jthread thread_;  ///< last member: the others must exist as long as it runs
};

}  // namespace prismesh::drivers::haptic_pen::framed

// Runs the simulated servo in real time: a thread acts as the device on a pseudo-terminal (or any port), for demonstrations and for tests
// of whole processes. Destroying it together with the port simulates an unplug.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>

#include "base/clock.h"
#include "drivers/port/byte_port.h"
#include "drivers/prism_servo/dynamixel/simulated_servo.h"
#include "drivers/settings/settings.h"

namespace prismesh::drivers::prism_servo::dynamixel {

/// Returns a simulated servo with the settings' mounting of the mask and the factory baud rate.
SimulatedServoSettings simulated_servo_settings(const settings::PrismServoSettings& settings);

class SimulatedServoThread {
 public:
  /// `device_end`: a PtyPair's master. Steps about every millisecond.
  SimulatedServoThread(std::unique_ptr<port::BytePort> device_end, const SimulatedServoSettings& settings);
  ~SimulatedServoThread() = default;
  SimulatedServoThread(const SimulatedServoThread&) = delete;
  SimulatedServoThread& operator=(const SimulatedServoThread&) = delete;

  // May be called from any thread; take effect at the next step.
  void jam(bool jammed) { jammed_ = jammed; }
  void set_power(bool on) { powered_ = on; }
  double mask_mm() const { return mask_mm_; }  ///< true position of the mask

 private:
  void run(const std::stop_token& stop);

  std::unique_ptr<port::BytePort> port_;
  SimulatedServo servo_;
  MonotonicClock clock_;
  std::atomic<bool> jammed_ = false, powered_ = true;
  std::atomic<double> mask_mm_ = 0;
  std::jthread thread_;  ///< last member: the others must exist as long as it runs
};

}  // namespace prismesh::drivers::prism_servo::dynamixel

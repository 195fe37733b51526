// The simulated servo in real time: a thread that plays the device's side of a pseudo-terminal (or of any port), for the demonstration and
// for tests of whole processes. Destroying it with the port is how the cable is pulled.
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

/// A simulated servo whose mask hangs as the settings say, with the factory's line speed.
SimulatedServoSettings simulated_servo_settings(const settings::PrismServoSettings& settings);

class SimulatedServoThread {
 public:
  /// `device_end`: a PtyPair's master. Steps about every millisecond.
  SimulatedServoThread(std::unique_ptr<port::BytePort> device_end, const SimulatedServoSettings& settings);
  ~SimulatedServoThread() = default;
  SimulatedServoThread(const SimulatedServoThread&) = delete;
  SimulatedServoThread& operator=(const SimulatedServoThread&) = delete;

  // From any thread; they take effect at the next step.
  void jam(bool jammed) { jammed_ = jammed; }
  void set_power(bool on) { powered_ = on; }
  double mask_mm() const { return mask_mm_; }  ///< where the mask truly is

 private:
  void run(const std::stop_token& stop);

  std::unique_ptr<port::BytePort> port_;
  SimulatedServo servo_;
  MonotonicClock clock_;
  std::atomic<bool> jammed_ = false, powered_ = true;
  std::atomic<double> mask_mm_ = 0;
  std::jthread thread_;  ///< last: everything is there before it runs, and stays until it has ended
};

}  // namespace prismesh::drivers::prism_servo::dynamixel

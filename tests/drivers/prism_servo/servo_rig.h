// A servo, its cable and its driver in virtual time.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "base/clock.h"
#include "drivers/port/memory_line.h"
#include "drivers/prism_servo/dynamixel/servo.h"
#include "drivers/prism_servo/dynamixel/simulated_servo.h"

namespace prismesh::drivers::prism_servo::dynamixel {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kTickNs = 5 * kMs;

struct RigSettings {
  SimulatedServoSettings simulated;
  ServoSettings driver;
  std::int64_t latency_ns = 0;
};

class ServoRig {
 public:
  explicit ServoRig(const RigSettings& settings = {})
      : line_(clock_, {.host_baud = 9600, .device_baud = settings.simulated.baud, .latency_ns = settings.latency_ns}),
        simulated_(line_.device(), settings.simulated),
        driver_settings_(settings.driver) {
    clock_.advance_ns(1'000 * kMs);
    plug();
  }

  /// Opens the port and creates a driver on it, as the daemon does when a device appears.
  void plug() {
    driver_.reset();
    if (!line_.plugged_in()) line_.plug_in();
    port_ = std::move(line_.open_host().value());
    driver_.emplace(*port_, driver_settings_);
    if (watched_) driver_.emplace(*watched_, driver_settings_);
  }

  /// One tick of the device loop.
  PrismServo::Tick tick() {
    last_ = driver_->tick(clock_.now_ns(), goal_mm, powered);
    for (int i = 0; i < 20; ++i) {
      clock_.advance_ns(kTickNs / 20);
      simulated_.step(clock_.now_ns());
    }
    return last_;
  }
  void run_for(std::int64_t ns) {
    for (const std::int64_t end = clock_.now_ns() + ns; clock_.now_ns() < end;) tick();
  }
  /// Milliseconds until the condition holds, or -1 after `max_ms`.
  std::int64_t run_until(const std::function<bool()>& so, std::int64_t max_ms = 10'000) {
    const std::int64_t start = clock_.now_ns();
    while (!so()) {
      if (clock_.now_ns() - start > max_ms * kMs) return -1;
      tick();
    }
    return (clock_.now_ns() - start) / kMs;
  }
  bool ready() const { return last_.phase == ServoPhase::ready; }
  std::int64_t run_until_ready(std::int64_t max_ms = 10'000) {
    return run_until([this] { return ready(); }, max_ms);
  }
  /// Advances time without the host, as with a stalled daemon.
  void stall(std::int64_t ns) {
    for (const std::int64_t end = clock_.now_ns() + ns; clock_.now_ns() < end;) {
      clock_.advance_ns(kTickNs / 20);
      simulated_.step(clock_.now_ns());
    }
  }

  double goal_mm = 0;
  bool powered = false;

  ManualClock& clock() { return clock_; }
  port::MemoryLine& line() { return line_; }
  SimulatedServo& simulated() { return simulated_; }
  Servo& driver() { return *driver_; }
  const PrismServo::Tick& last() const { return last_; }
  port::BytePort& port() { return *port_; }
  /// From now on the driver uses this port instead of the line's own.
  void put_between(port::BytePort& watched) {
    watched_ = &watched;
    driver_.emplace(watched, driver_settings_);
  }

 private:
  ManualClock clock_;
  port::MemoryLine line_;
  SimulatedServo simulated_;
  ServoSettings driver_settings_;
  std::unique_ptr<port::BytePort> port_;
  port::BytePort* watched_ = nullptr;
  std::optional<Servo> driver_;
  PrismServo::Tick last_;
};

}  // namespace prismesh::drivers::prism_servo::dynamixel

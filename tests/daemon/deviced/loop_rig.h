// A complete device station in virtual time: the real loop with its real drivers, simulated devices at the other ends of two cables in
// memory, and the port keepers that a thread would run.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/clock.h"
#include "daemon/deviced/loop.h"
#include "drivers/eye_tracker/dynasight/simulator.h"
#include "drivers/port/memory_line.h"
#include "drivers/prism_servo/dynamixel/simulated_servo.h"
#include "ipc/device/page.h"

namespace prismesh::deviced {

inline constexpr std::int64_t kMs = 1'000'000;

/// Six centimetres to either side in six seconds.
inline drivers::eye_tracker::SimulatedHead swaying_head(double seconds) {
  drivers::eye_tracker::SimulatedHead head;
  head.between_eyes_mm = {60 * std::sin(2 * 3.14159265 * seconds / 6), 20, 650};
  return head;
}

struct RigOptions {
  drivers::eye_tracker::HeadSource head = swaying_head;
  drivers::eye_tracker::dynasight::DynasightSimulator::Options tracker;
  drivers::prism_servo::dynamixel::SimulatedServoSettings servo = {.baud = 1'000'000, .return_delay = 0};
  LoopSettings loop;
};

class LoopRig {
 public:
  explicit LoopRig(const RigOptions& options = {})
      : tracker_line(clock, {.host_baud = 19200, .device_baud = 19200}),
        tracker(tracker_line.device(), options.head, options.tracker),
        tracker_keeper(clock, [this] { return tracker_line.open_host(); }),
        servo_line(clock, {.host_baud = 1'000'000, .device_baud = options.servo.baud}),
        servo(servo_line.device(), options.servo),
        servo_keeper(clock, [this] { return servo_line.open_host(1'000'000); }),
        page(ipc::DevicePage::create().value()),
        reader(ipc::DevicePageReader::map(page.descriptor()).value()),
        loop(options.loop, {&tracker_keeper, nullptr, &servo_keeper}, page) {
    clock.advance_ns(1'000 * kMs);
  }

  /// One period: advances the devices in steps of a millisecond, runs the keepers, then ticks the loop.
  void tick() {
    for (std::int64_t step = 0; step < kTickPeriodNs; step += kMs) {
      clock.advance_ns(kMs);
      tracker.run_until(clock.now_ns());
      servo.step(clock.now_ns());
    }
    tracker_keeper.work();
    servo_keeper.work();
    if (before_tick) before_tick();
    loop.tick(clock.now_ns());
    if (after_tick) after_tick();
  }
  void run_for_ms(std::int64_t ms) {
    for (const std::int64_t end = clock.now_ns() + ms * kMs; clock.now_ns() < end;) tick();
  }
  /// Milliseconds until the condition holds; -1 if it doesn't within `max_ms`.
  std::int64_t run_until(const std::function<bool()>& so, std::int64_t max_ms = 10'000) {
    const std::int64_t start = clock.now_ns();
    while (!so()) {
      if (clock.now_ns() - start >= max_ms * kMs) return -1;
      tick();
    }
    return (clock.now_ns() - start) / kMs;
  }
  /// Runs until both devices work.
  void start() {
    ASSERT_GE(run_until([this] { return tracking() && following(); }), 0) << state();
  }

  void plug_in_tracker() {
    tracker_line.plug_in();
    tracker_keeper.retry_now();
  }
  void plug_in_servo() {
    servo_line.plug_in();
    servo_keeper.retry_now();
  }

  // The state on the page.
  ipc::EyesState eyes() const { return reader.eyes().value_or(ipc::EyesState{}); }
  ipc::PrismState mask() const { return reader.prism().value_or(ipc::PrismState{}); }
  bool tracking() const { return eyes().phase == ipc::EyesPhase::tracking; }
  bool following() const { return mask().phase == drivers::prism_servo::MaskPhase::following && mask().stereo_allowed; }
  double eyes_age_ms() { return static_cast<double>(clock.now_ns() - eyes().measured_ns) * 1e-6; }
  std::string state() {
    return "eyes phase " + std::to_string(static_cast<int>(eyes().phase)) + ", mask phase " +
           std::to_string(static_cast<int>(mask().phase));
  }
  std::vector<LoopEvent> events() {
    std::vector<LoopEvent> all;
    while (const std::optional<LoopEvent> event = loop.next_event()) all.push_back(*event);
    return all;
  }

  ManualClock clock;
  drivers::port::MemoryLine tracker_line;
  drivers::eye_tracker::dynasight::DynasightSimulator tracker;
  drivers::port::PortKeeper tracker_keeper;
  drivers::port::MemoryLine servo_line;
  drivers::prism_servo::dynamixel::SimulatedServo servo;
  drivers::port::PortKeeper servo_keeper;
  ipc::DevicePage page;
  ipc::DevicePageReader reader;
  DeviceLoop loop;
  std::function<void()> before_tick, after_tick;  ///< called around the loop's own tick
};

}  // namespace prismesh::deviced

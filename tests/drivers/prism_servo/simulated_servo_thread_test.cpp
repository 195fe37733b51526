// The simulated servo behind a real pseudo-terminal, in real time. Checks only that it works, not its speed.
#include "drivers/prism_servo/dynamixel/simulated_servo_thread.h"

#include <chrono>
#include <optional>
#include <thread>

#include <gtest/gtest.h>

#include "drivers/port/open_port.h"
#include "drivers/port/pty_pair.h"
#include "drivers/prism_servo/dynamixel/servo.h"

namespace prismesh::drivers::prism_servo::dynamixel {
namespace {

TEST(simulated_servo_thread, a_driver_finds_and_moves_it_over_a_pseudo_terminal) {
  const settings::PrismServoSettings settings;
  std::optional<port::PtyPair> pty(port::open_pty_pair().value());
  const std::string path = pty->slave_path;
  std::optional<SimulatedServoThread> servo;
  servo.emplace(std::move(pty->master), simulated_servo_settings(settings));
  auto port = port::open_port(path, settings.baud);
  ASSERT_TRUE(port) << port.error().text();
  Servo driver(**port, servo_settings(settings).value());
  MonotonicClock clock;
  const auto run_until = [&](auto so) {
    PrismServo::Tick tick;
    for (const std::int64_t end = clock.now_ns() + 20'000'000'000; clock.now_ns() < end;) {
      tick = driver.tick(clock.now_ns(), -1.0, true);
      if (so(tick)) return tick;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    ADD_FAILURE() << "it took too long";
    return tick;
  };
  run_until([](const PrismServo::Tick& tick) { return tick.phase == ServoPhase::ready; });
  run_until([&](const PrismServo::Tick& tick) { return tick.fresh && std::abs(tick.reading.position_mm + 1.0) < 0.003; });
  EXPECT_NEAR(servo->mask_mm(), -1.0, 0.02);
  servo.reset();  // closes the pseudo-terminal too
  run_until([](const PrismServo::Tick& tick) { return tick.status == port::PortStatus::gone; });
}

}  // namespace
}  // namespace prismesh::drivers::prism_servo::dynamixel

#include "drivers/prism_servo/dynamixel/servo.h"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/drivers/prism_servo/servo_rig.h"

namespace prismesh::drivers::prism_servo::dynamixel {
namespace {

using testing::HasSubstr;

/// Passes bytes on and records them.
class WatchedPort final : public port::BytePort {
 public:
  explicit WatchedPort(port::BytePort& port) : port_(port) {}
  port::PortCount read(std::span<std::byte> to) override {
    const port::PortCount count = port_.read(to);
    read_ += count.bytes;
    return count;
  }
  port::PortCount write(std::span<const std::byte> from) override {
    parser_.take(from);
    while (const Packet* packet = parser_.next())
      if (packet->instruction == Instruction::write)
        writes_.push_back(
            {static_cast<std::uint16_t>(number_at(packet->data(), 0, 2)), packet->count, number_at(packet->data(), 2, packet->count - 2U)});
    written_ += from.size();
    return port_.write(from);
  }
  void discard_input() override { port_.discard_input(); }
  bool set_baud(int baud) override {
    ++speeds_set_;
    return port_.set_baud(baud);
  }
  int last_error() const override { return port_.last_error(); }

  struct Write {
    std::uint16_t address;
    std::size_t count;
    std::uint32_t value;
  };
  const std::vector<Write>& writes() const { return writes_; }
  int speeds_set() const { return speeds_set_; }
  std::size_t bytes_read() const { return read_; }
  std::size_t bytes_written() const { return written_; }

 private:
  port::BytePort& port_;
  Parser parser_;
  std::vector<Write> writes_;
  std::size_t read_ = 0, written_ = 0;
  int speeds_set_ = 0;
};

TEST(dynamixel_servo, is_found_and_set_up_from_factory_settings) {
  ServoRig rig;
  const std::int64_t ms = rig.run_until_ready();
  EXPECT_GT(ms, 0);
  EXPECT_LT(ms, 1'000);
  SimulatedServo& servo = rig.simulated();
  EXPECT_EQ(servo.value(kBaudRate), 3U);
  EXPECT_EQ(servo.value(kReturnDelayTime), 0U);
  EXPECT_EQ(servo.value(kOperatingMode), kPositionMode);
  EXPECT_EQ(servo.value(kStatusReturnLevel), kAnswerReads);
  EXPECT_EQ(servo.value(kBusWatchdog), 5U);
  EXPECT_EQ(servo.value(kProfileVelocity), 263U);  // 5 mm/s at 5 mm per turn: 60 turns per minute
  EXPECT_EQ(servo.value(kMinPositionLimit), 2048U - 1638U);
  EXPECT_EQ(servo.value(kMaxPositionLimit), 2048U + 1638U);
  EXPECT_FALSE(servo.torque());
  EXPECT_EQ(rig.driver().model(), 1030);
  EXPECT_EQ(rig.driver().found_baud(), 1'000'000);
}

TEST(dynamixel_servo, is_found_at_every_baud_rate) {
  for (const int baud : kBauds) {
    RigSettings settings;
    settings.simulated.baud = baud;
    ServoRig rig(settings);
    EXPECT_GT(rig.run_until_ready(), 0) << baud;
    EXPECT_EQ(rig.simulated().value(kBaudRate), 3U);
  }
}

TEST(dynamixel_servo, writes_eeprom_only_once) {
  ServoRig rig;
  ASSERT_GT(rig.run_until_ready(), 0);
  const std::uint64_t first = rig.simulated().counts().eeprom_writes;
  EXPECT_EQ(first, 4U);  // baud rate, return delay, both limits
  rig.plug();
  rig.run_for(100 * kMs);
  ASSERT_GE(rig.run_until_ready(), 0);
  EXPECT_EQ(rig.simulated().counts().eeprom_writes, first);
}

TEST(dynamixel_servo, is_set_up_from_any_settings) {
  for (const unsigned level : {0U, 1U, 2U}) {
    RigSettings settings;
    settings.simulated.baud = 1'000'000;
    ServoRig rig(settings);
    SimulatedServo& servo = rig.simulated();
    servo.set_value(kStatusReturnLevel, level);
    servo.set_value(kTorqueEnable, 1);  // EEPROM is locked
    servo.set_value(kBusWatchdog, kWatchdogTripped);
    servo.set_value(kOperatingMode, 16);
    servo.set_value(kDriveMode, 0x0D);
    servo.set_value(kHomingOffset, 1000);
    EXPECT_GT(rig.run_until_ready(), 0) << level;
    EXPECT_EQ(servo.value(kOperatingMode), kPositionMode);
    EXPECT_EQ(servo.value(kDriveMode), 0U);
    EXPECT_EQ(servo.value(kHomingOffset), 0U);
  }
}

TEST(dynamixel_servo, follows_goals_and_reports_its_position) {
  for (const bool reversed : {false, true}) {
    RigSettings settings;
    settings.simulated.reversed = settings.driver.reversed = reversed;
    ServoRig rig(settings);
    ASSERT_GT(rig.run_until_ready(), 0);
    rig.powered = true;
    for (const double goal : {-1.9, 0.0, 1.9}) {
      rig.goal_mm = goal;
      rig.run_for(100 * kMs);
      EXPECT_NEAR(rig.last().reading.velocity_mm_s, std::copysign(5, goal - rig.last().reading.position_mm), 0.1) << "on the way";
      rig.run_for(900 * kMs);
      EXPECT_NEAR(rig.simulated().motor_mm(), goal, 0.001);
      EXPECT_NEAR(rig.last().reading.position_mm, goal, 0.001);
    }
  }
}

TEST(dynamixel_servo, reads_at_nearly_every_tick) {
  ServoRig rig;
  ASSERT_GT(rig.run_until_ready(), 0);
  rig.powered = true;
  rig.goal_mm = -1.9;
  constexpr int kTicks = 80;
  int fresh = 0;
  double fastest_mm_s = 0;
  for (int i = 0; i < kTicks; ++i) {
    const PrismServo::Tick tick = rig.tick();
    fresh += tick.fresh ? 1 : 0;
    fastest_mm_s = std::max(fastest_mm_s, -tick.reading.velocity_mm_s);
  }
  EXPECT_GE(fresh, kTicks * 14 / 16);
  EXPECT_NEAR(fastest_mm_s, 5.02, 0.05);
}

TEST(dynamixel_servo, a_readings_time_matches_its_position) {
  for (const std::int64_t latency : {std::int64_t{0}, std::int64_t{300'000}}) {
    RigSettings settings;
    settings.latency_ns = latency;
    ServoRig rig(settings);
    ASSERT_GT(rig.run_until_ready(), 0);
    rig.powered = true;
    std::vector<std::pair<std::int64_t, double>> path;
    double worst = 0;
    for (int i = 0; i < 400; ++i) {
      rig.goal_mm = i < 200 ? -1.5 : 1.5;
      const PrismServo::Tick tick = rig.driver().tick(rig.clock().now_ns(), rig.goal_mm, true);
      if (tick.fresh && path.size() > 200) {
        const auto at = std::lower_bound(path.begin(), path.end(), std::pair(tick.reading.measured_ns, -100.0));
        if (at != path.end()) worst = std::max(worst, std::abs(at->second - tick.reading.position_mm));
      }
      for (int step = 0; step < 100; ++step) {
        rig.clock().advance_ns(kTickNs / 100);
        rig.simulated().step(rig.clock().now_ns());
        path.emplace_back(rig.clock().now_ns(), rig.simulated().motor_mm());
      }
    }
    EXPECT_LT(worst, 5.0 * 0.0006 + 0.0013) << "half a millisecond at 5 mm/s and a tick of the encoder";
  }
}

TEST(dynamixel_servo, no_reading_is_in_the_future) {
  RigSettings settings;
  settings.driver.baud = 9'600;
  ServoRig rig(settings);
  ASSERT_GT(rig.run_until_ready(), 0);
  rig.powered = true;
  std::array<std::byte, kMaxPacketLength> stray;
  const std::size_t size = encode_status(1, 0, std::array<std::uint8_t, 8>{}, stray);
  int fresh = 0;
  for (int i = 0; i < 400; ++i) {
    // An unexpected answer among the real ones.
    if (i % 7 == 0) rig.line().inject(port::Direction::to_host, std::span(stray).first(size));
    const std::int64_t now = rig.clock().now_ns();
    const PrismServo::Tick tick = rig.tick();
    EXPECT_LE(tick.reading.measured_ns, now);
    fresh += tick.fresh ? 1 : 0;
  }
  EXPECT_GT(fresh, 20);
}

TEST(dynamixel_servo, a_tick_fits_into_200_hz) {
  ServoRig rig;
  WatchedPort port(rig.port());
  rig.put_between(port);
  rig.powered = true;
  ASSERT_GT(rig.run_until_ready(), 0);
  rig.run_for(100 * kMs);
  const std::uint64_t timeouts = rig.driver().counts().timeouts;
  const std::size_t written = port.bytes_written(), read = port.bytes_read();
  constexpr int kTicks = 1'600;
  rig.run_for(kTicks * kTickNs);
  const double out = static_cast<double>(port.bytes_written() - written) / kTicks;
  const double in = static_cast<double>(port.bytes_read() - read) / kTicks;
  EXPECT_NEAR(out, 16 + 14, 0.1);
  EXPECT_NEAR(in, 19, 0.6);
  const double line_ms = (out + in) * 10 / 1'000'000 * 1e3;
  EXPECT_LT(line_ms, 0.5);
  RecordProperty("line_us_a_tick", std::to_string(line_ms * 1e3));
  EXPECT_EQ(rig.driver().counts().timeouts, timeouts);
}

TEST(dynamixel_servo, works_at_the_slow_default_baud_rate_too) {
  RigSettings settings;
  settings.driver.baud = 57'600;
  ServoRig rig(settings);
  ASSERT_GT(rig.run_until_ready(), 0);
  rig.powered = true;
  rig.goal_mm = -1.5;
  rig.run_for(1'500 * kMs);
  EXPECT_NEAR(rig.last().reading.position_mm, -1.5, 0.001);
  EXPECT_EQ(rig.driver().counts().timeouts, 0U);
  EXPECT_EQ(rig.driver().counts().bad_packets, 0U);
}

TEST(dynamixel_servo, works_with_an_adapter_that_delays_bytes) {
  RigSettings settings;
  settings.latency_ns = 8 * kMs;  // each way: FTDI's 16 ms
  ServoRig rig(settings);
  ASSERT_GT(rig.run_until_ready(), 0);
  const std::uint64_t timeouts = rig.driver().counts().timeouts;
  rig.powered = true;
  rig.goal_mm = -1.5;
  rig.run_for(2'000 * kMs);
  EXPECT_NEAR(rig.last().reading.position_mm, -1.5, 0.001);
  EXPECT_EQ(rig.driver().counts().timeouts, timeouts);
}

TEST(dynamixel_servo, tolerates_its_own_echo) {
  RigSettings settings;
  settings.simulated.echoes = true;
  settings.simulated.baud = 1'000'000;
  ServoRig rig(settings);
  ASSERT_GT(rig.run_until_ready(), 0);
  rig.powered = true;
  rig.goal_mm = 1.2;
  rig.run_for(1'000 * kMs);
  EXPECT_NEAR(rig.last().reading.position_mm, 1.2, 0.001);
  EXPECT_EQ(rig.driver().counts().bad_packets, 0U);
}

TEST(dynamixel_servo, ignores_another_servos_answers) {
  ServoRig rig;
  std::array<std::byte, kMaxPacketLength> pong, motion;
  const std::size_t pong_size = encode_status(2, 0, std::array<std::uint8_t, 3>{0x5E, 0x01, 1}, pong);  // model 350
  const std::size_t motion_size = encode_status(2, 0, std::array<std::uint8_t, 8>{}, motion);           // at tick 0: -2.5 mm
  for (int i = 0; i < 400; ++i) {
    // On the line before the answer to this tick's request.
    rig.line().inject(port::Direction::to_host, rig.ready() ? std::span(motion).first(motion_size) : std::span(pong).first(pong_size));
    rig.powered = rig.ready();
    const PrismServo::Tick tick = rig.tick();
    ASSERT_EQ(tick.trouble, ServoTrouble::none) << "tick " << i;
    if (tick.fresh) {
      EXPECT_NEAR(tick.reading.position_mm, rig.simulated().motor_mm(), 0.05) << "tick " << i;
    }
  }
  EXPECT_TRUE(rig.ready());
  EXPECT_EQ(rig.driver().model(), 1030);
}

TEST(dynamixel_servo, impossible_goals_are_never_sent) {
  ServoRig rig;
  WatchedPort port(rig.port());
  rig.put_between(port);
  ASSERT_GT(rig.run_until_ready(), 0);
  rig.powered = true;
  const double inf = std::numeric_limits<double>::infinity();
  for (const double goal : {0.5, std::nan(""), inf, -inf, 1e300, -1e300, 1e18, -3.0, 2.0001}) {
    const double stands = rig.simulated().motor_mm();
    rig.goal_mm = goal;
    rig.run_for(60 * kTickNs);
    if (!std::isfinite(goal)) {
      EXPECT_NEAR(rig.simulated().motor_mm(), stands, 0.001) << "holds its last goal";
    }
  }
  int goals = 0;
  for (const WatchedPort::Write& write : port.writes()) {
    if (write.address != kGoalPosition.address) continue;
    ++goals;
    EXPECT_GE(write.value, 2048U - 1638U);
    EXPECT_LE(write.value, 2048U + 1638U);
  }
  EXPECT_GT(goals, 80);
  EXPECT_EQ(rig.simulated().counts().goals_beyond_limits, 0U);
  EXPECT_EQ(rig.simulated().counts().refused, 0U);
}

TEST(dynamixel_servo, recovers_from_its_bus_watchdog) {
  ServoRig rig;
  ASSERT_GT(rig.run_until_ready(), 0);
  rig.powered = true;
  rig.goal_mm = -1.9;
  rig.run_for(200 * kMs);
  rig.stall(400 * kMs);
  EXPECT_TRUE(rig.simulated().watchdog_tripped());
  const double stopped = rig.simulated().motor_mm();
  rig.stall(400 * kMs);
  EXPECT_NEAR(rig.simulated().motor_mm(), stopped, 1e-6);
  rig.tick();
  const std::int64_t ms = rig.run_until([&] { return rig.driver().counts().watchdog_trips > 0 && rig.ready(); });
  EXPECT_GE(ms, 0);
  EXPECT_LT(ms, 300);
  rig.run_for(1'500 * kMs);
  EXPECT_EQ(rig.simulated().value(kProfileVelocity), 263U);
  EXPECT_NEAR(rig.simulated().motor_mm(), -1.9, 0.001);
}

TEST(dynamixel_servo, reads_the_watchdog_at_once_after_a_stall) {
  for (int ticks = 5; ticks < 45; ++ticks) {  // at any point of its cycle of checks
    ServoRig rig;
    ASSERT_GT(rig.run_until_ready(), 0);
    rig.powered = true;
    for (int i = 0; i < ticks; ++i) rig.tick();
    rig.stall(500 * kMs);
    ASSERT_TRUE(rig.simulated().watchdog_tripped());
    const std::int64_t ms = rig.run_until([&] { return !rig.ready(); }, 100);
    EXPECT_GE(ms, 0);
    EXPECT_LE(ms, 20) << "after " << ticks << " ticks";
  }
}

TEST(dynamixel_servo, switches_torque_off_and_on) {
  ServoRig rig;
  ASSERT_GT(rig.run_until_ready(), 0);
  rig.powered = true;
  rig.goal_mm = 1;
  rig.run_for(500 * kMs);
  EXPECT_TRUE(rig.simulated().torque());
  rig.powered = false;
  rig.run_for(3 * kTickNs);
  EXPECT_FALSE(rig.simulated().torque());
  rig.powered = true;
  rig.run_for(3 * kTickNs);
  EXPECT_TRUE(rig.simulated().torque());
}

TEST(dynamixel_servo, repeats_a_lost_torque_command) {
  ServoRig rig;
  ASSERT_GT(rig.run_until_ready(), 0);
  rig.powered = true;
  rig.run_for(200 * kMs);
  rig.simulated().set_value(kTorqueEnable, 0);
  rig.run_for(300 * kMs);
  EXPECT_TRUE(rig.simulated().torque());
}

TEST(dynamixel_servo, an_alarm_is_named_and_ends_with_a_reboot) {
  ServoRig rig;
  ASSERT_GT(rig.run_until_ready(), 0);
  rig.powered = true;
  rig.goal_mm = 1;
  rig.run_for(500 * kMs);
  rig.simulated().raise_hardware_error(1U << 5U | 1U << 2U);
  ASSERT_GE(rig.run_until([&] { return rig.last().phase == ServoPhase::alarm; }, 100), 0);
  EXPECT_FALSE(rig.simulated().torque());
  settings::PrismServoSettings settings;
  EXPECT_THAT(trouble_text(rig.last(), settings), HasSubstr("overheating, overload"));
  rig.run_for(1'000 * kMs);
  EXPECT_EQ(rig.last().phase, ServoPhase::alarm) << "latched";
  EXPECT_TRUE(rig.driver().tick(rig.clock().now_ns(), 0, true).phase == ServoPhase::alarm);
  rig.powered = false;
  rig.run_for(100 * kMs);
  EXPECT_EQ(rig.last().phase, ServoPhase::alarm);
  rig.powered = true;
  EXPECT_GE(rig.run_until_ready(2'000), 0);
  rig.run_for(1'000 * kMs);
  EXPECT_NEAR(rig.simulated().motor_mm(), 1, 0.001);
}

TEST(dynamixel_servo, names_a_second_fault_during_an_alarm) {
  for (const bool powered : {true, false}) {
    ServoRig rig;
    ASSERT_GT(rig.run_until_ready(), 0);
    rig.powered = powered;
    rig.run_for(100 * kMs);
    rig.simulated().raise_hardware_error(1U << 5U);
    ASSERT_GE(rig.run_until([&] { return rig.last().phase == ServoPhase::alarm; }, 100), 0);
    EXPECT_EQ(rig.last().alarm_bits, 1U << 5U);
    for (unsigned joined = 1U << 5U; const unsigned bit : {2U, 0U, 4U}) {
      rig.run_for(35 * kTickNs);
      joined |= 1U << bit;
      rig.simulated().raise_hardware_error(static_cast<std::uint8_t>(1U << bit));
      EXPECT_GE(rig.run_until([&] { return rig.last().alarm_bits == joined; }, 100), 0) << "bit " << bit << ", powered " << powered;
    }
    EXPECT_EQ(rig.last().phase, ServoPhase::alarm);
  }
}

TEST(dynamixel_servo, a_jam_ends_in_an_overload_alarm) {
  ServoRig rig;
  ASSERT_GT(rig.run_until_ready(), 0);
  rig.powered = true;
  rig.goal_mm = -1.5;
  rig.run_for(100 * kMs);
  rig.simulated().jam(true);
  const std::int64_t ms = rig.run_until([&] { return rig.last().phase == ServoPhase::alarm; });
  EXPECT_GT(ms, 1'400);
  EXPECT_EQ(rig.last().alarm_bits, 1U << 5U);
}

TEST(dynamixel_servo, detects_a_power_cut_and_restores_the_settings) {
  ServoRig rig;
  ASSERT_GT(rig.run_until_ready(), 0);
  rig.powered = true;
  rig.run_for(500 * kMs);
  rig.simulated().set_power(false);
  EXPECT_GE(rig.run_until([&] { return rig.last().phase == ServoPhase::absent; }, 200), 0);
  rig.run_for(3'000 * kMs);
  settings::PrismServoSettings settings;
  EXPECT_THAT(trouble_text(rig.last(), settings), HasSubstr("answers"));
  rig.simulated().set_power(true);
  const std::int64_t ms = rig.run_until_ready(2'000);
  EXPECT_GE(ms, 0);
  rig.run_for(500 * kMs);
  EXPECT_TRUE(rig.simulated().torque());
  EXPECT_EQ(rig.simulated().value(kBusWatchdog), 5U);
  EXPECT_EQ(rig.simulated().value(kProfileVelocity), 263U);
  EXPECT_THAT(trouble_text(rig.last(), settings), "");
}

TEST(dynamixel_servo, detects_a_power_cut_shorter_than_the_timeouts) {
  RigSettings settings;
  settings.simulated.boot_ns = 8 * kMs;
  ServoRig rig(settings);
  ASSERT_GT(rig.run_until_ready(), 0);
  rig.powered = true;
  rig.run_for(500 * kMs);
  rig.simulated().set_power(false);
  rig.tick();
  rig.simulated().set_power(true);
  EXPECT_EQ(rig.simulated().value(kBusWatchdog), 0U);
  rig.run_for(600 * kMs);
  EXPECT_EQ(rig.simulated().value(kBusWatchdog), 5U);
  EXPECT_EQ(rig.simulated().value(kStatusReturnLevel), kAnswerReads);
  EXPECT_TRUE(rig.simulated().torque());
}

TEST(dynamixel_servo, after_an_unplug_at_any_byte_is_gone_and_comes_back) {
  RigSettings settings;
  settings.simulated.baud = 1'000'000;
  ServoRig rig(settings);
  for (std::size_t byte = 1; byte < 600; byte += 7) {
    rig.powered = true;
    rig.goal_mm = byte % 2 == 0 ? -1 : 1;
    rig.line().unplug_after(byte % 3 == 0 ? port::Direction::to_device : port::Direction::to_host, byte);
    ASSERT_GE(rig.run_until([&] { return rig.last().status == port::PortStatus::gone; }), 0) << byte;
    EXPECT_EQ(rig.last().phase, ServoPhase::absent);
    rig.plug();
    rig.tick();
    ASSERT_GE(rig.run_until_ready(2'000), 0) << byte;
  }
}

TEST(dynamixel_servo, noise_loses_readings_only) {
  ServoRig rig;
  ASSERT_GT(rig.run_until_ready(), 0);
  rig.powered = true;
  rig.line().set_noise(0.0005, 0.0005, 3);
  rig.goal_mm = 1;
  rig.run_for(5'000 * kMs);
  EXPECT_GT(rig.driver().counts().timeouts + rig.driver().counts().bad_packets, 10U);
  rig.line().set_noise(0, 0, 3);
  rig.run_for(1'500 * kMs);
  EXPECT_TRUE(rig.ready());
  EXPECT_NEAR(rig.simulated().motor_mm(), 1, 0.001);
  EXPECT_EQ(rig.simulated().counts().goals_beyond_limits, 0U);
}

TEST(dynamixel_servo, searches_slowly_if_no_servo_answers) {
  ServoRig rig;
  WatchedPort port(rig.port());
  rig.put_between(port);
  rig.simulated().set_power(false);
  rig.run_for(3'000 * kMs);
  const int before = port.speeds_set();
  rig.run_for(10'000 * kMs);
  EXPECT_GT(port.speeds_set(), before + 20);
  EXPECT_LE(port.speeds_set(), before + 60);
  rig.simulated().set_power(true);
  EXPECT_GE(rig.run_until_ready(6'000), 0) << "at the factory's speed, which it has yet";
}

TEST(dynamixel_servo, another_model_is_not_written_to) {
  RigSettings settings;
  settings.simulated.model = 350;  // XL-320: different registers
  ServoRig rig(settings);
  rig.powered = true;
  rig.run_for(3'000 * kMs);
  EXPECT_EQ(rig.last().phase, ServoPhase::absent);
  EXPECT_EQ(rig.last().trouble, ServoTrouble::other_model);
  EXPECT_THAT(trouble_text(rig.last(), {}), HasSubstr("model 350"));
  EXPECT_EQ(rig.simulated().counts().eeprom_writes, 0U);
}

TEST(dynamixel_servo, retries_once_a_second_after_a_refusal) {
  RigSettings settings;
  settings.simulated.model = 350;
  ServoRig rig(settings);
  WatchedPort port(rig.port());
  rig.put_between(port);
  ASSERT_GE(rig.run_until([&] { return rig.last().trouble == ServoTrouble::other_model; }), 0);
  const std::size_t written = port.bytes_written();
  rig.run_for(980 * kMs);
  EXPECT_EQ(port.bytes_written(), written);
  rig.run_for(40 * kMs);
  EXPECT_GT(port.bytes_written(), written);
}

TEST(dynamixel_servo, reports_a_register_that_cannot_be_read) {
  ServoRig rig;
  ASSERT_GE(rig.run_until([&] { return rig.last().phase == ServoPhase::setting_up; }), 0);
  std::array<std::byte, kMaxPacketLength> refusal;
  const std::size_t size = encode_status(1, 7, {}, refusal);  // access error
  for (int i = 0; i < 20 && rig.last().trouble == ServoTrouble::none; ++i) {
    rig.line().inject(port::Direction::to_host, std::span(refusal).first(size));
    rig.tick();
  }
  EXPECT_EQ(rig.last().trouble, ServoTrouble::refused);
  EXPECT_EQ(rig.last().phase, ServoPhase::absent);
}

TEST(dynamixel_servo, its_bus_watchdog_is_off_while_it_is_set_up) {
  ServoRig rig;
  rig.simulated().set_value(kBusWatchdog, kWatchdogTripped);
  WatchedPort port(rig.port());
  rig.put_between(port);
  ASSERT_GT(rig.run_until_ready(), 0);
  std::vector<std::uint32_t> watchdog;
  for (const WatchedPort::Write& write : port.writes())
    if (write.address == kBusWatchdog.address) watchdog.push_back(write.value);
  // A set-up takes longer than the watchdog's time, and only writing zero clears a tripped watchdog.
  EXPECT_THAT(watchdog, ElementsAre(0U, 5U));
}

TEST(dynamixel_servo, reports_a_velocity_limit_that_is_too_low) {
  ServoRig rig;
  rig.simulated().set_value(kVelocityLimit, 100);
  rig.run_for(2'000 * kMs);
  EXPECT_EQ(rig.last().trouble, ServoTrouble::too_slow);
  EXPECT_THAT(trouble_text(rig.last(), {}), HasSubstr("register 44"));
  rig.simulated().set_value(kVelocityLimit, 330);
  EXPECT_GE(rig.run_until_ready(3'000), 0);
}

TEST(dynamixel_servo, reports_settings_that_cannot_work) {
  settings::PrismServoSettings settings;
  settings.port = "/dev/ttyUSB3";
  EXPECT_TRUE(servo_settings(settings).has_value());
  const auto message = [](const settings::PrismServoSettings& bad) { return servo_settings(bad).error().text(); };
  settings::PrismServoSettings bad = settings;
  bad.zero_ticks = 100;
  EXPECT_THAT(message(bad), HasSubstr("/dev/ttyUSB3"));
  EXPECT_THAT(message(bad), HasSubstr("encoder's turn"));
  bad = settings;
  bad.baud = 38'400;
  EXPECT_THAT(message(bad), HasSubstr("38400"));
  bad = settings;
  bad.id = 253;
  EXPECT_THAT(message(bad), HasSubstr("253"));
  bad = settings;
  bad.travel_mm = std::nan("");
  EXPECT_THAT(message(bad), HasSubstr("above zero"));
}

}  // namespace
}  // namespace prismesh::drivers::prism_servo::dynamixel

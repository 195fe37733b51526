// The simulated servo against the manual: what is sent, and what comes back, byte for byte.
#include "drivers/prism_servo/dynamixel/simulated_servo.h"

#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/clock.h"
#include "drivers/port/memory_line.h"

namespace prismesh::drivers::prism_servo::dynamixel {
namespace {

using testing::IsEmpty;
using Bytes = std::vector<std::uint8_t>;

class Bench {
 public:
  explicit Bench(SimulatedServoSettings settings = {}, int host_baud = 57'600)
      : line_(clock_, {.host_baud = host_baud, .device_baud = settings.baud}), servo_(line_.device(), settings) {
    host_ = std::move(line_.open_host().value());
    wait_ms(1);
  }
  /// What comes back within 20 ms.
  Bytes say(const Bytes& bytes, int ms = 20) {
    host_->write(std::as_bytes(std::span(bytes)));
    wait_ms(ms);
    return heard();
  }
  Bytes write(Register which, std::uint32_t value) {
    std::array<std::byte, kLongestPacket> packet;
    const std::size_t size = encode_write(1, which.address, value, which.size, packet);
    host_->write(std::span(packet).first(size));
    wait_ms(20);
    return heard();
  }
  Bytes heard() {
    std::array<std::byte, 512> buffer;
    const std::size_t count = host_->read(buffer).bytes;
    Bytes bytes;
    for (std::size_t i = 0; i < count; ++i) bytes.push_back(std::to_integer<std::uint8_t>(buffer[i]));
    return bytes;
  }
  void wait_ms(double ms) {
    for (const std::int64_t end = clock_.now_ns() + static_cast<std::int64_t>(ms * 1e6); clock_.now_ns() < end;) {
      clock_.advance_ns(250'000);
      servo_.step(clock_.now_ns());
    }
  }
  SimulatedServo& servo() { return servo_; }
  port::BytePort& host() { return *host_; }

 private:
  ManualClock clock_;
  port::MemoryLine line_;
  SimulatedServo servo_;
  std::unique_ptr<port::BytePort> host_;
};

Bytes answer(std::uint8_t error, const Bytes& data = {}) {
  std::array<std::byte, kLongestPacket> packet;
  const std::size_t size = encode_status(1, error, data, packet);
  Bytes bytes;
  for (std::size_t i = 0; i < size; ++i) bytes.push_back(std::to_integer<std::uint8_t>(packet[i]));
  return bytes;
}

constexpr auto kRange = static_cast<std::uint8_t>(Refusal::range);
constexpr auto kLimit = static_cast<std::uint8_t>(Refusal::limit);
constexpr auto kAccess = static_cast<std::uint8_t>(Refusal::access);

TEST(simulated_servo, speaks_the_manuals_dialogue) {
  SimulatedServoSettings settings;
  settings.start_mm = (166 - 2048) / 4096.0 * 5;
  settings.stop_mm = 3;
  Bench bench(settings);
  bench.servo().set_value(kFirmwareVersion, 38);
  EXPECT_EQ(bench.say({0xFF, 0xFF, 0xFD, 0, 1, 3, 0, 1, 0x19, 0x4E}),
            (Bytes{0xFF, 0xFF, 0xFD, 0, 1, 7, 0, 0x55, 0, 6, 4, 0x26, 0x65, 0x5D}));
  EXPECT_EQ(bench.say({0xFF, 0xFF, 0xFD, 0, 1, 7, 0, 2, 0x84, 0, 4, 0, 0x1D, 0x15}),
            (Bytes{0xFF, 0xFF, 0xFD, 0, 1, 8, 0, 0x55, 0, 0xA6, 0, 0, 0, 0x8C, 0xC0}));
  EXPECT_EQ(bench.say({0xFF, 0xFF, 0xFD, 0, 1, 9, 0, 3, 0x74, 0, 0, 2, 0, 0, 0xCA, 0x89}),
            (Bytes{0xFF, 0xFF, 0xFD, 0, 1, 4, 0, 0x55, 0, 0xA1, 0x0C}));
}

TEST(simulated_servo, hears_nothing_at_another_speed) {
  Bench bench({}, 115'200);
  EXPECT_THAT(bench.say({0xFF, 0xFF, 0xFD, 0, 1, 3, 0, 1, 0x19, 0x4E}), IsEmpty());
  bench.host().set_baud(57'600);
  EXPECT_FALSE(bench.say({0xFF, 0xFF, 0xFD, 0, 1, 3, 0, 1, 0x19, 0x4E}).empty());
}

TEST(simulated_servo, keeps_its_memory_locked_while_torque_is_on) {
  Bench bench;
  EXPECT_EQ(bench.write(kTorqueEnable, 1), answer(0));
  EXPECT_EQ(bench.write(kReturnDelayTime, 0), answer(kAccess));
  EXPECT_EQ(bench.servo().value(kReturnDelayTime), 250U);
  EXPECT_EQ(bench.write(kTorqueEnable, 0), answer(0));
  EXPECT_EQ(bench.write(kReturnDelayTime, 0), answer(0));
}

TEST(simulated_servo, answers_after_its_return_delay) {
  Bench bench;
  std::array<std::byte, kLongestPacket> packet;
  bench.host().write(std::span(packet).first(encode_ping(1, packet)));
  const double out_ms = 10 * 10 / 57.6, back_ms = 14 * 10 / 57.6;
  bench.wait_ms(out_ms + 0.5 + back_ms - 0.3);
  EXPECT_LT(bench.heard().size(), 14U);
  bench.wait_ms(1);
  EXPECT_FALSE(bench.heard().empty());
}

TEST(simulated_servo, answers_as_much_as_its_status_level_says) {
  Bench bench;
  const Bytes ping = {0xFF, 0xFF, 0xFD, 0, 1, 3, 0, 1, 0x19, 0x4E};
  const Bytes read = {0xFF, 0xFF, 0xFD, 0, 1, 7, 0, 2, 0x84, 0, 4, 0, 0x1D, 0x15};
  EXPECT_THAT(bench.write(kStatusReturnLevel, 1), IsEmpty());
  EXPECT_FALSE(bench.say(read).empty());
  EXPECT_THAT(bench.write(kStatusReturnLevel, 0), IsEmpty());
  EXPECT_THAT(bench.say(read), IsEmpty());
  EXPECT_FALSE(bench.say(ping).empty());
}

TEST(simulated_servo, refuses_goals_beyond_limits_and_after_its_watchdog) {
  Bench bench;
  EXPECT_EQ(bench.write(kMaxPositionLimit, 3000), answer(0));
  EXPECT_EQ(bench.write(kTorqueEnable, 1), answer(0));
  EXPECT_EQ(bench.write(kGoalPosition, 3001), answer(kLimit));
  EXPECT_EQ(bench.write(kGoalPosition, 2100), answer(0));
  EXPECT_EQ(bench.write(kProfileVelocity, 50), answer(0));
  EXPECT_EQ(bench.write(kBusWatchdog, 3), answer(0));
  bench.wait_ms(65);
  EXPECT_TRUE(bench.servo().watchdog_tripped());
  EXPECT_EQ(bench.servo().value(kProfileVelocity), 0U);
  EXPECT_EQ(bench.write(kGoalPosition, 2200), answer(kRange));
  EXPECT_EQ(bench.write(kBusWatchdog, 0), answer(0));
  EXPECT_EQ(bench.write(kGoalPosition, 2200), answer(0));
}

TEST(simulated_servo, shuts_down_and_comes_back_only_by_a_reboot) {
  Bench bench;
  bench.write(kTorqueEnable, 1);
  bench.servo().raise_hardware_error(1U << 4U);
  EXPECT_FALSE(bench.servo().torque());
  EXPECT_EQ(bench.write(kTorqueEnable, 1), answer(kAlertBit | static_cast<std::uint8_t>(Refusal::failed)));
  bench.say({0xFF, 0xFF, 0xFD, 0, 1, 3, 0, 8, 0x2F, 0x4E}, 400);
  EXPECT_EQ(bench.write(kTorqueEnable, 1), answer(0));
}

TEST(simulated_servo, changes_its_speed_after_the_answer) {
  Bench bench;
  EXPECT_EQ(bench.write(kBaudRate, 3), answer(0));
  const Bytes ping = {0xFF, 0xFF, 0xFD, 0, 1, 3, 0, 1, 0x19, 0x4E};
  EXPECT_THAT(bench.say(ping), IsEmpty());
  bench.host().set_baud(1'000'000);
  EXPECT_FALSE(bench.say(ping).empty());
}

TEST(simulated_servo, moves_as_fast_as_its_profile_lags_and_has_play) {
  SimulatedServoSettings settings;
  settings.start_mm = 0;
  settings.backlash_mm = 0.04;
  Bench bench(settings);
  bench.write(kProfileVelocity, 105);  // 2 mm/s
  bench.write(kTorqueEnable, 1);
  bench.write(kGoalPosition, 2048 + 1229);  // 1.5 mm
  bench.wait_ms(300);
  const double there = bench.servo().motor_mm();
  bench.wait_ms(100);
  EXPECT_NEAR(bench.servo().motor_mm() - there, 0.2, 0.003);
  EXPECT_NEAR(bench.servo().motor_mm() - bench.servo().mask_mm(), 0.02, 1e-9);
  bench.wait_ms(800);
  EXPECT_NEAR(bench.servo().motor_mm(), 1.5, 0.001);
  bench.write(kGoalPosition, 2048);
  bench.wait_ms(1'500);
  EXPECT_NEAR(bench.servo().mask_mm() - bench.servo().motor_mm(), 0.02, 1e-9);
}

TEST(simulated_servo, stops_at_its_ends_and_shuts_down_there) {
  SimulatedServoSettings settings;
  settings.stop_mm = 1;
  Bench bench(settings);
  bench.write(kTorqueEnable, 1);
  bench.write(kGoalPosition, 4000);
  bench.wait_ms(1'000);
  EXPECT_NEAR(bench.servo().motor_mm(), 1, 1e-9);
  bench.wait_ms(1'500);
  EXPECT_EQ(bench.servo().value(kHardwareErrorStatus), 1U << 5U);
  EXPECT_FALSE(bench.servo().torque());
}

}  // namespace
}  // namespace prismesh::drivers::prism_servo::dynamixel

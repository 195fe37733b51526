// Compares the simulated servo with the manual: requests and answers, byte for byte.
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

class ServoFixture {
 public:
  explicit ServoFixture(SimulatedServoSettings settings = {}, int host_baud = 57'600)
      : line_(clock_, {.host_baud = host_baud, .device_baud = settings.baud}), servo_(line_.device(), settings) {
    host_ = std::move(line_.open_host().value());
    wait_ms(1);
  }
  /// Sends bytes and returns the answers within `ms`.
  Bytes send(const Bytes& bytes, int ms = 20) {
    host_->write(std::as_bytes(std::span(bytes)));
    wait_ms(ms);
    return received();
  }
  Bytes write(Register which, std::uint32_t value) {
    std::array<std::byte, kMaxPacketLength> packet;
    const std::size_t size = encode_write(1, which.address, value, which.size, packet);
    host_->write(std::span(packet).first(size));
    wait_ms(20);
    return received();
  }
  Bytes received() {
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
  std::array<std::byte, kMaxPacketLength> packet;
  const std::size_t size = encode_status(1, error, data, packet);
  Bytes bytes;
  for (std::size_t i = 0; i < size; ++i) bytes.push_back(std::to_integer<std::uint8_t>(packet[i]));
  return bytes;
}

constexpr auto kRange = static_cast<std::uint8_t>(Refusal::range);
constexpr auto kLimit = static_cast<std::uint8_t>(Refusal::limit);
constexpr auto kAccess = static_cast<std::uint8_t>(Refusal::access);

TEST(simulated_servo, follows_the_manuals_dialogue) {
  SimulatedServoSettings settings;
  settings.start_mm = (166 - 2048) / 4096.0 * 5;
  settings.stop_mm = 3;
  ServoFixture fixture(settings);
  fixture.servo().set_value(kFirmwareVersion, 38);
  EXPECT_EQ(fixture.send({0xFF, 0xFF, 0xFD, 0, 1, 3, 0, 1, 0x19, 0x4E}),
            (Bytes{0xFF, 0xFF, 0xFD, 0, 1, 7, 0, 0x55, 0, 6, 4, 0x26, 0x65, 0x5D}));
  EXPECT_EQ(fixture.send({0xFF, 0xFF, 0xFD, 0, 1, 7, 0, 2, 0x84, 0, 4, 0, 0x1D, 0x15}),
            (Bytes{0xFF, 0xFF, 0xFD, 0, 1, 8, 0, 0x55, 0, 0xA6, 0, 0, 0, 0x8C, 0xC0}));
  EXPECT_EQ(fixture.send({0xFF, 0xFF, 0xFD, 0, 1, 9, 0, 3, 0x74, 0, 0, 2, 0, 0, 0xCA, 0x89}),
            (Bytes{0xFF, 0xFF, 0xFD, 0, 1, 4, 0, 0x55, 0, 0xA1, 0x0C}));
}

TEST(simulated_servo, ignores_bytes_at_another_baud_rate) {
  ServoFixture fixture({}, 115'200);
  EXPECT_THAT(fixture.send({0xFF, 0xFF, 0xFD, 0, 1, 3, 0, 1, 0x19, 0x4E}), IsEmpty());
  fixture.host().set_baud(57'600);
  EXPECT_FALSE(fixture.send({0xFF, 0xFF, 0xFD, 0, 1, 3, 0, 1, 0x19, 0x4E}).empty());
}

TEST(simulated_servo, locks_its_eeprom_while_torque_is_on) {
  ServoFixture fixture;
  EXPECT_EQ(fixture.write(kTorqueEnable, 1), answer(0));
  EXPECT_EQ(fixture.write(kReturnDelayTime, 0), answer(kAccess));
  EXPECT_EQ(fixture.servo().value(kReturnDelayTime), 250U);
  EXPECT_EQ(fixture.write(kTorqueEnable, 0), answer(0));
  EXPECT_EQ(fixture.write(kReturnDelayTime, 0), answer(0));
}

TEST(simulated_servo, answers_after_its_return_delay) {
  ServoFixture fixture;
  std::array<std::byte, kMaxPacketLength> packet;
  fixture.host().write(std::span(packet).first(encode_ping(1, packet)));
  const double out_ms = 10 * 10 / 57.6, back_ms = 14 * 10 / 57.6;
  fixture.wait_ms(out_ms + 0.5 + back_ms - 0.3);
  EXPECT_LT(fixture.received().size(), 14U);
  fixture.wait_ms(1);
  EXPECT_FALSE(fixture.received().empty());
}

TEST(simulated_servo, answers_according_to_its_status_level) {
  ServoFixture fixture;
  const Bytes ping = {0xFF, 0xFF, 0xFD, 0, 1, 3, 0, 1, 0x19, 0x4E};
  const Bytes read = {0xFF, 0xFF, 0xFD, 0, 1, 7, 0, 2, 0x84, 0, 4, 0, 0x1D, 0x15};
  EXPECT_THAT(fixture.write(kStatusReturnLevel, 1), IsEmpty());
  EXPECT_FALSE(fixture.send(read).empty());
  EXPECT_THAT(fixture.write(kStatusReturnLevel, 0), IsEmpty());
  EXPECT_THAT(fixture.send(read), IsEmpty());
  EXPECT_FALSE(fixture.send(ping).empty());
}

TEST(simulated_servo, refuses_goals_beyond_limits_and_after_its_watchdog) {
  ServoFixture fixture;
  EXPECT_EQ(fixture.write(kMaxPositionLimit, 3000), answer(0));
  EXPECT_EQ(fixture.write(kTorqueEnable, 1), answer(0));
  EXPECT_EQ(fixture.write(kGoalPosition, 3001), answer(kLimit));
  EXPECT_EQ(fixture.write(kGoalPosition, 2100), answer(0));
  EXPECT_EQ(fixture.write(kProfileVelocity, 50), answer(0));
  EXPECT_EQ(fixture.write(kBusWatchdog, 3), answer(0));
  fixture.wait_ms(65);
  EXPECT_TRUE(fixture.servo().watchdog_tripped());
  EXPECT_EQ(fixture.servo().value(kProfileVelocity), 0U);
  EXPECT_EQ(fixture.write(kGoalPosition, 2200), answer(kRange));
  EXPECT_EQ(fixture.write(kBusWatchdog, 0), answer(0));
  EXPECT_EQ(fixture.write(kGoalPosition, 2200), answer(0));
}

TEST(simulated_servo, a_shutdown_ends_only_with_a_reboot) {
  ServoFixture fixture;
  fixture.write(kTorqueEnable, 1);
  fixture.servo().raise_hardware_error(1U << 4U);
  EXPECT_FALSE(fixture.servo().torque());
  EXPECT_EQ(fixture.write(kTorqueEnable, 1), answer(kAlertBit | static_cast<std::uint8_t>(Refusal::failed)));
  fixture.send({0xFF, 0xFF, 0xFD, 0, 1, 3, 0, 8, 0x2F, 0x4E}, 400);
  EXPECT_EQ(fixture.write(kTorqueEnable, 1), answer(0));
}

TEST(simulated_servo, changes_its_baud_rate_after_the_answer) {
  ServoFixture fixture;
  EXPECT_EQ(fixture.write(kBaudRate, 3), answer(0));
  const Bytes ping = {0xFF, 0xFF, 0xFD, 0, 1, 3, 0, 1, 0x19, 0x4E};
  EXPECT_THAT(fixture.send(ping), IsEmpty());
  fixture.host().set_baud(1'000'000);
  EXPECT_FALSE(fixture.send(ping).empty());
}

TEST(simulated_servo, moves_at_its_profile_speed_with_lag_and_backlash) {
  SimulatedServoSettings settings;
  settings.start_mm = 0;
  settings.backlash_mm = 0.04;
  ServoFixture fixture(settings);
  fixture.write(kProfileVelocity, 105);  // 2 mm/s
  fixture.write(kTorqueEnable, 1);
  fixture.write(kGoalPosition, 2048 + 1229);  // 1.5 mm
  fixture.wait_ms(300);
  const double there = fixture.servo().motor_mm();
  fixture.wait_ms(100);
  EXPECT_NEAR(fixture.servo().motor_mm() - there, 0.2, 0.003);
  EXPECT_NEAR(fixture.servo().motor_mm() - fixture.servo().mask_mm(), 0.02, 1e-9);
  fixture.wait_ms(800);
  EXPECT_NEAR(fixture.servo().motor_mm(), 1.5, 0.001);
  fixture.write(kGoalPosition, 2048);
  fixture.wait_ms(1'500);
  EXPECT_NEAR(fixture.servo().mask_mm() - fixture.servo().motor_mm(), 0.02, 1e-9);
}

TEST(simulated_servo, stops_at_its_ends_and_shuts_down) {
  SimulatedServoSettings settings;
  settings.stop_mm = 1;
  ServoFixture fixture(settings);
  fixture.write(kTorqueEnable, 1);
  fixture.write(kGoalPosition, 4000);
  fixture.wait_ms(1'000);
  EXPECT_NEAR(fixture.servo().motor_mm(), 1, 1e-9);
  fixture.wait_ms(1'500);
  EXPECT_EQ(fixture.servo().value(kHardwareErrorStatus), 1U << 5U);
  EXPECT_FALSE(fixture.servo().torque());
}

}  // namespace
}  // namespace prismesh::drivers::prism_servo::dynamixel

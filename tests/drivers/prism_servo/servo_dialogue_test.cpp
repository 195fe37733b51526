// The servo driver with faulty lines, servos and settings.
#include "drivers/prism_servo/dynamixel/servo.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/drivers/prism_servo/servo_rig.h"

namespace prismesh::drivers::prism_servo::dynamixel {
namespace {

using testing::HasSubstr;

/// Passes calls on to another port; tests override the faulty ones.
class PassingPort : public port::BytePort {
 public:
  explicit PassingPort(port::BytePort& port) : port_(port) {}
  port::PortCount read(std::span<std::byte> to) override { return port_.read(to); }
  port::PortCount write(std::span<const std::byte> from) override { return port_.write(from); }
  void discard_input() override { port_.discard_input(); }
  bool set_baud(int baud) override { return port_.set_baud(baud); }
  int last_error() const override { return port_.last_error(); }

 private:
  port::BytePort& port_;
};

/// Loses the writes to one register.
class DeafRegister final : public PassingPort {
 public:
  DeafRegister(port::BytePort& port, Register which) : PassingPort(port), which_(which) {}
  port::PortCount write(std::span<const std::byte> from) override {
    bool is_for_it = false;
    parser_.take(from);
    while (const Packet* packet = parser_.next())
      is_for_it = is_for_it || (packet->instruction == Instruction::write && number_at(packet->data(), 0, 2) == which_.address);
    if (!is_for_it || !deaf) return PassingPort::write(from);
    ++lost;
    return {from.size(), port::PortStatus::ok};
  }
  bool deaf = true;
  int lost = 0;

 private:
  Register which_;
  Parser parser_;
};

/// Returns bytes a few reads late.
class SlowAdapterPort final : public PassingPort {
 public:
  using PassingPort::PassingPort;
  port::PortCount read(std::span<std::byte> to) override {
    std::vector<std::byte> bytes(to.size());
    bytes.resize(PassingPort::read(bytes).bytes);
    held_.push_back(std::move(bytes));
    std::size_t count = 0;
    for (; held_.size() > reads_late; held_.pop_front()) {
      std::copy(held_.front().begin(), held_.front().end(), to.begin() + static_cast<std::ptrdiff_t>(count));
      count += held_.front().size();
    }
    return {count, port::PortStatus::ok};
  }
  std::size_t reads_late = 0;

 private:
  std::deque<std::vector<std::byte>> held_;
};

TEST(servo_set_up, reports_and_retries_a_register_that_does_not_keep_its_value) {
  struct Case {
    Register which;
    std::uint32_t value;
    int writes = 3;
  };
  for (const Case& wrong : std::vector<Case>{{kTorqueEnable, 1},
                                             {kBaudRate, 1, 4},
                                             {kReturnDelayTime, 250},
                                             {kDriveMode, 1},
                                             {kOperatingMode, 16},
                                             {kHomingOffset, 1000},
                                             {kMaxPositionLimit, 4095},
                                             {kMinPositionLimit, 0},
                                             {kProfileAcceleration, 7},
                                             {kProfileVelocity, 1},
                                             {kBusWatchdog, 0}}) {
    RigSettings settings;
    settings.simulated.baud = wrong.which == kBaudRate ? 57'600 : 1'000'000;
    ServoRig rig(settings);
    rig.simulated().set_value(wrong.which, wrong.value);
    DeafRegister port(rig.port(), wrong.which);
    rig.put_between(port);
    rig.powered = true;
    const std::string number = std::to_string(wrong.which.address);
    EXPECT_GE(rig.run_until([&] { return rig.last().trouble != ServoTrouble::none; }, 1'000), 0) << number;
    EXPECT_EQ(rig.last().trouble, ServoTrouble::refused) << number;
    EXPECT_EQ(rig.last().phase, ServoPhase::absent) << number;
    EXPECT_THAT(trouble_text(rig.last(), {}), HasSubstr("its register " + number + " has"));
    EXPECT_EQ(port.lost, wrong.writes) << number;
    port.deaf = false;
    EXPECT_GT(rig.run_until_ready(2'000), 0) << number;
    EXPECT_THAT(trouble_text(rig.last(), {}), "") << number;
  }
}

TEST(servo_set_up, late_answers_are_not_taken_for_other_registers) {
  for (int from = 4; from < 50; ++from)
    for (int ticks = 8; ticks < 14; ++ticks) {
      RigSettings settings;
      settings.simulated.baud = 1'000'000;
      settings.simulated.return_delay = 0;
      ServoRig rig(settings);
      // This register is among correct ones; if it were mistaken for one of those, it wouldn't be written.
      rig.simulated().set_value(kDriveMode, 1);
      rig.simulated().set_value(kHomingOffset, 1000);
      rig.simulated().set_value(kProfileAcceleration, 20);
      SlowAdapterPort port(rig.port());
      rig.put_between(port);
      rig.run_for(from * kTickNs);
      port.reads_late = 7;  // one tick longer than the driver waits for answers
      rig.run_for(ticks * kTickNs);
      port.reads_late = 0;
      ASSERT_GE(rig.run_until_ready(3'000), 0) << from << ' ' << ticks;
      EXPECT_EQ(rig.simulated().value(kDriveMode), 0U) << from << ' ' << ticks;
      EXPECT_EQ(rig.simulated().value(kHomingOffset), 0U) << from << ' ' << ticks;
      EXPECT_EQ(rig.simulated().value(kProfileAcceleration), 0U) << from << ' ' << ticks;
    }
}

TEST(servo_set_up, the_watchdog_time_is_rounded_up) {
  const std::pair<std::int64_t, std::uint32_t> cases[] = {{0, 1},         {1, 1},         {20 * kMs, 1},         {20 * kMs + 1, 2},
                                                          {100 * kMs, 5}, {101 * kMs, 6}, {3'600'000 * kMs, 127}};
  for (const auto& [watchdog_ns, units] : cases) {
    RigSettings settings;
    settings.driver.watchdog_ns = watchdog_ns;
    ServoRig rig(settings);
    ASSERT_GT(rig.run_until_ready(), 0) << watchdog_ns;
    EXPECT_EQ(rig.simulated().value(kBusWatchdog), units) << watchdog_ns;
  }
}

TEST(servo_set_up, skips_a_baud_rate_that_the_adapter_does_not_support) {
  struct SlowAdapter final : PassingPort {
    using PassingPort::PassingPort;
    bool set_baud(int baud) override { return baud <= 115'200 && PassingPort::set_baud(baud); }
  };
  for (std::int64_t silent_ms = 0; silent_ms < 400; silent_ms += 35) {
    RigSettings settings;
    settings.driver.baud = 57'600;
    ServoRig rig(settings);
    SlowAdapter port(rig.port());
    rig.put_between(port);
    rig.simulated().mute(true);
    rig.run_for(silent_ms * kMs);
    rig.simulated().mute(false);
    EXPECT_GE(rig.run_until_ready(), 0) << silent_ms;
    EXPECT_EQ(rig.driver().found_baud(), 57'600) << "after " << silent_ms << " ms";
  }
}

TEST(servo_dialogue, occasional_lost_requests_do_not_lose_the_servo) {
  ServoRig rig;
  ASSERT_GT(rig.run_until_ready(), 0);
  rig.powered = true;
  const std::uint64_t before = rig.driver().counts().timeouts;
  int fresh = 0;
  for (int i = 0; i < 1'200; ++i) {
    rig.simulated().mute(i % 30 == 0);
    fresh += rig.tick().fresh ? 1 : 0;
    ASSERT_TRUE(rig.ready()) << "tick " << i;
  }
  EXPECT_GE(rig.driver().counts().timeouts - before, 35U);
  EXPECT_GE(fresh, 800);
}

TEST(servo_dialogue, waits_for_an_adapter_that_becomes_slow) {
  ServoRig rig;
  SlowAdapterPort port(rig.port());
  rig.put_between(port);
  ASSERT_GT(rig.run_until_ready(), 0);
  rig.powered = true;
  rig.run_for(4'000 * kMs);  // it has learnt this adapter's delay
  port.reads_late = 3;
  int fresh = 0;
  for (int i = 0; i < 400; ++i) {
    fresh += rig.tick().fresh ? 1 : 0;
    ASSERT_TRUE(rig.ready()) << "tick " << i;
  }
  EXPECT_GE(fresh, 60);
}

TEST(servo_dialogue, answers_of_another_length_and_errors_are_no_readings) {
  for (const bool refusals : {false, true}) {
    ServoRig rig;
    ASSERT_GT(rig.run_until_ready(), 0);
    rig.powered = true;
    rig.goal_mm = -1;
    int fresh = 0;
    for (int i = 0; i < 600; ++i) {
      // On the line before the answer to this tick's request.
      if (i % 5 == 0) {
        std::array<std::byte, kMaxPacketLength> stray;
        const std::array<std::uint8_t, 12> zeros{};
        const std::size_t lengths[] = {0, 3, 4, 7, 9, 12};
        const auto data = std::span(zeros).first(refusals ? 0 : lengths[static_cast<std::size_t>(i / 5) % 6]);
        rig.line().inject(port::Direction::to_host, std::span(stray).first(encode_status(1, refusals ? 4 : 0, data, stray)));
      }
      const PrismServo::Tick tick = rig.tick();
      ASSERT_EQ(tick.phase, ServoPhase::ready) << "tick " << i;
      if (!tick.fresh) continue;
      ++fresh;
      EXPECT_NEAR(tick.reading.position_mm, rig.simulated().motor_mm(), 0.06) << "tick " << i;
    }
    EXPECT_GE(fresh, 350);
    EXPECT_NEAR(rig.simulated().motor_mm(), -1, 0.001);
  }
}

TEST(servo_dialogue, a_continuous_stream_does_not_block_the_tick) {
  struct Flood final : PassingPort {
    using PassingPort::PassingPort;
    port::PortCount read(std::span<std::byte> to) override {
      std::fill(to.begin(), to.end(), std::byte{0x55});
      if (++reads > 1'000'000) return {};
      return {to.size(), port::PortStatus::ok};
    }
    int reads = 0;
  };
  ServoRig rig;
  Flood port(rig.port());
  rig.put_between(port);
  rig.tick();
  EXPECT_LE(port.reads, 20);
}

TEST(servo_positions, stay_within_the_travel_and_convert_back) {
  ServoSettings settings;
  settings.travel_mm_per_turn = 8;  // 512 ticks per millimetre
  settings.travel_mm = 1.5;
  settings.zero_ticks = 1'000;
  const double infinity = std::numeric_limits<double>::infinity();
  struct Case {
    double mm;
    std::int32_t from_zero;
  };
  for (const Case& place : {Case{0, 0}, Case{1, 512}, Case{-1, -512}, Case{1.5, 768}, Case{1.6, 768}, Case{-1.6, -768}, Case{infinity, 768},
                            Case{-infinity, -768}, Case{std::nan(""), 0}, Case{0.5 / 512 + 1e-6, 1}, Case{0.5 / 512 - 1e-6, 0}}) {
    settings.reversed = false;
    EXPECT_EQ(ticks_from_mm(settings, place.mm), 1'000 + place.from_zero) << place.mm;
    settings.reversed = true;
    EXPECT_EQ(ticks_from_mm(settings, place.mm), 1'000 - place.from_zero) << place.mm;
  }
  for (const bool reversed : {false, true}) {
    settings.reversed = reversed;
    for (double mm = -1.5; mm <= 1.5; mm += 0.25) EXPECT_DOUBLE_EQ(mm_from_ticks(settings, ticks_from_mm(settings, mm)), mm);
  }
}

TEST(servo_positions, speeds_are_rounded_up_and_limited_to_the_registers_range) {
  ServoSettings settings;
  settings.travel_mm_per_turn = 5;
  EXPECT_EQ(velocity_units(settings, 5), 263U);  // 60 turns per minute
  EXPECT_EQ(velocity_units(settings, 2.5), 132U);
  EXPECT_EQ(velocity_units(settings, 1e-9), 1U) << "0 would be as fast as it can";
  EXPECT_EQ(velocity_units(settings, 1e9), 32'767U);
  settings.travel_mm_per_turn = 10;
  EXPECT_EQ(velocity_units(settings, 5), 132U);
}

TEST(servo_settings, are_converted_each_to_its_own_unit) {
  settings::PrismServoSettings from;
  from.id = 7;
  from.baud = 57'600;
  from.travel_mm_per_turn = 4;
  from.reversed = true;
  from.zero_ticks = 1'900;
  from.travel_mm = 1.25;
  from.speed_mm_s = 3;
  from.lag_ms = 12.5;
  const ServoSettings to = servo_settings(from).value();
  EXPECT_EQ(to.id, 7);
  EXPECT_EQ(to.baud, 57'600);
  EXPECT_EQ(to.travel_mm_per_turn, 4);
  EXPECT_TRUE(to.reversed);
  EXPECT_EQ(to.zero_ticks, 1'900);
  EXPECT_EQ(to.travel_mm, 1.25);
  EXPECT_EQ(to.speed_mm_s, 3);
  EXPECT_EQ(to.lag_ns, 12'500'000);
}

TEST(servo_settings, refuses_each_value_that_no_servo_supports) {
  using Change = void (*)(settings::PrismServoSettings&);
  struct Case {
    Change change;
    const char* says;  ///< "": accepted
  };
  const Case cases[] = {
      {[](auto& s) { s.id = -1; }, "prism_servo.id is -1"},
      {[](auto& s) { s.id = 0; }, ""},
      {[](auto& s) { s.id = 252; }, ""},
      {[](auto& s) { s.baud = 9'601; }, "prism_servo.baud is 9601"},
      {[](auto& s) { s.baud = 4'500'000; }, ""},
      {[](auto& s) { s.travel_mm_per_turn = 0; }, "above zero"},
      {[](auto& s) { s.travel_mm_per_turn = -5; }, "above zero"},
      {[](auto& s) { s.travel_mm_per_turn = HUGE_VAL; }, "above zero"},
      {[](auto& s) { s.travel_mm = 0; }, "above zero"},
      {[](auto& s) { s.travel_mm = -2; }, "above zero"},
      {[](auto& s) { s.speed_mm_s = 0; }, "above zero"},
      {[](auto& s) { s.speed_mm_s = std::nan(""); }, "above zero"},
      {[](auto& s) { s.lag_ms = -0.1; }, "lag_ms at least zero"},
      {[](auto& s) { s.lag_ms = std::nan(""); }, "lag_ms at least zero"},
      {[](auto& s) { s.lag_ms = HUGE_VAL; }, "lag_ms at least zero"},
      {[](auto& s) { s.lag_ms = 0; }, ""},
      // 2 mm at 8 mm per turn are 1024 ticks to either side.
      {[](auto& s) { s.travel_mm_per_turn = 8, s.zero_ticks = 1'024; }, ""},
      {[](auto& s) { s.travel_mm_per_turn = 8, s.zero_ticks = 1'023; }, "encoder's turn"},
      {[](auto& s) { s.travel_mm_per_turn = 8, s.zero_ticks = 3'071; }, ""},
      {[](auto& s) { s.travel_mm_per_turn = 8, s.zero_ticks = 3'072; }, "encoder's turn"},
  };
  for (const Case& one : cases) {
    settings::PrismServoSettings settings;
    one.change(settings);
    const Result<ServoSettings> result = servo_settings(settings);
    const auto number = &one - cases;
    EXPECT_EQ(result.has_value(), std::string(one.says).empty()) << number;
    if (!result) {
      EXPECT_THAT(result.error().text(), HasSubstr(one.says)) << number;
    }
  }
}

TEST(servo_trouble, names_every_fault_of_an_alarm_in_order) {
  PrismServo::Tick tick;
  tick.phase = ServoPhase::alarm;
  tick.alarm_bits = 0xFF;
  EXPECT_THAT(
      trouble_text(tick, {}),
      HasSubstr("(input voltage, motor sensor, overheating, motor encoder, electrical shock, overload, unknown fault, unknown fault)"));
  tick.alarm_bits = 1;
  EXPECT_THAT(trouble_text(tick, {}), HasSubstr("(input voltage)"));
}

TEST(servo_trouble, names_the_servo_and_port_that_do_not_answer) {
  settings::PrismServoSettings settings;
  settings.id = 7;
  settings.port = "/dev/ttyUSB3";
  PrismServo::Tick tick;
  tick.trouble = ServoTrouble::no_answer;
  EXPECT_THAT(trouble_text(tick, settings), HasSubstr("no servo with id 7 answers on /dev/ttyUSB3 at any speed"));
}

}  // namespace
}  // namespace prismesh::drivers::prism_servo::dynamixel

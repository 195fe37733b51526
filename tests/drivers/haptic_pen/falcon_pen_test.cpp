// The Falcon's driver before a simulated one that speaks its bytes, in virtual time.
#include "drivers/haptic_pen/falcon/falcon_pen.h"

#include <cmath>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/haptic_pen/falcon/simulated_falcon.h"
#include "drivers/haptics/haptic_loop.h"

namespace prismesh::drivers::haptic_pen::falcon {
namespace {

constexpr std::int64_t kTickNs = 1'000'000;

SimulatedHand circling(double seconds) {
  SimulatedHand hand;
  hand.goal_mm = {15 * std::sin(3 * seconds), 15 * std::cos(3 * seconds) - 15, 10 * std::sin(seconds)};
  return hand;
}

struct FalconRig {
  explicit FalconRig(SimulatedFalconOptions options = {}, FalconOptions driver = {.firmware = pretended_firmware(4000)},
                     HandSource hand = homing_hand(circling))
      : device(options, std::move(hand), [this](std::int64_t, const ForcePacket& packet) { seen.push_back(packet); }),
        cable(clock, device),
        port(cable.open()),
        pen(*port, std::move(driver)) {}

  PenReading tick(const Eigen::Vector3d& newton = Eigen::Vector3d::Zero()) {
    for (int part = 0; part < 4; ++part) {
      clock.advance_ns(kTickNs / 4);
      cable.run();
    }
    const PenReading reading = pen.read(clock.now_ns());
    if (reading.fresh) last = reading.pose;
    lost += reading.lost_replies;
    replies += reading.replies;
    if (reading.trouble == PenTrouble::bad_reply) ++bad;
    pen.send(clock.now_ns(), {newton, clock.now_ns() + 3 * kTickNs});
    return reading;
  }
  /// Ticks until the phase is reached; the ticks, or nothing after a minute.
  std::optional<int> until(PenPhase phase) {
    for (int i = 0; i < 60'000; ++i)
      if (tick().phase == phase) return i;
    return std::nullopt;
  }

  ManualClock clock;
  std::vector<ForcePacket> seen;
  SimulatedFalcon device;
  port::MemoryUsb cable;
  std::unique_ptr<port::UsbPort> port;
  FalconPen pen;
  PenPose last;
  std::uint32_t lost = 0, replies = 0, bad = 0;
};

TEST(FalconPenTest, goes_from_the_plug_to_poses) {
  FalconRig rig;
  EXPECT_EQ(rig.tick().phase, PenPhase::setting_up);
  ASSERT_TRUE(rig.until(PenPhase::homing)) << rig.pen.advice();
  EXPECT_EQ(rig.device.loaded(), pretended_firmware(4000));
  EXPECT_EQ(rig.pen.advice(), "home it by hand: pull the grip all the way out, then push it all the way in (arms to go: top, right, left)");
  EXPECT_EQ(rig.last.measured_ns, 0);
  ASSERT_TRUE(rig.until(PenPhase::ready));
  EXPECT_EQ(rig.pen.advice(), "");
  double largest_mm = 0;
  for (int i = 0; i < 3000; ++i) {
    rig.tick();
    largest_mm = std::max(largest_mm, (rig.last.position_mm - rig.device.pen().position_mm()).norm());
  }
  // An encoder's step, and the way within the age of the pose.
  EXPECT_LT(largest_mm, 0.25);
  EXPECT_EQ(rig.lost, 0u);
  EXPECT_EQ(rig.bad, 0u);
  EXPECT_GT(rig.replies, 2900u);
}

TEST(FalconPenTest, shows_its_progress_while_it_loads) {
  FalconRig rig;
  int percents = 0;
  std::string before;
  for (int i = 0; i < 20'000 && rig.tick().phase == PenPhase::setting_up; ++i)
    if (const std::string now = rig.pen.advice(); std::exchange(before, now) != now && now.starts_with("the firmware is being loaded: "))
      ++percents;
  EXPECT_GT(percents, 50);
}

TEST(FalconPenTest, needs_no_firmware_where_some_runs) {
  FalconRig rig({.runs = true, .homed = true}, {}, circling);
  const auto ticks = rig.until(PenPhase::ready);
  ASSERT_TRUE(ticks);
  EXPECT_LT(*ticks, 500);
  EXPECT_TRUE(rig.device.loaded().empty());
}

TEST(FalconPenTest, every_packet_has_the_homing_bit) {
  FalconRig rig;
  ASSERT_TRUE(rig.until(PenPhase::ready));
  for (int i = 0; i < 100; ++i) rig.tick({1, 0, 0});
  ASSERT_GT(rig.seen.size(), 1000u);
  EXPECT_THAT(rig.seen, testing::Each(testing::Field(&ForcePacket::homing, true)));
  EXPECT_TRUE(decode_force(zero_packet())->homing);
}

TEST(FalconPenTest, the_lights_say_what_it_does) {
  FalconRig rig;
  ASSERT_TRUE(rig.until(PenPhase::homing));
  rig.tick(), rig.tick(), rig.tick();
  EXPECT_EQ(rig.seen.back().lights, kRed);
  ASSERT_TRUE(rig.until(PenPhase::ready));
  rig.tick(), rig.tick(), rig.tick();
  EXPECT_EQ(rig.seen.back().lights, kGreen);
  for (int i = 0; i < 10; ++i) rig.tick({1, 0, 0});
  EXPECT_EQ(rig.seen.back().lights, kBlue);
}

TEST(FalconPenTest, a_force_arrives_at_the_grip_as_it_was_asked_for) {
  SimulatedFalconOptions options{.runs = true, .homed = true};
  FalconRig rig(options, {}, circling);
  ASSERT_TRUE(rig.until(PenPhase::ready));
  for (const Eigen::Vector3d& newton : {Eigen::Vector3d(2, 0, 0), Eigen::Vector3d(0, -1.5, 0), Eigen::Vector3d(1, 1, 2)}) {
    for (int i = 0; i < 20; ++i) rig.tick(newton);
    // A unit of a motor is about a millinewton.
    EXPECT_LT((rig.device.newton() - newton).norm(), 0.02) << rig.device.newton().transpose();
  }
}

TEST(FalconPenTest, a_weighed_device_gets_more_units) {
  std::array<int, 2> units{};
  for (const std::size_t which : {0u, 1u}) {
    FalconRig rig({.runs = true, .homed = true}, {.firmware = {}, .force_scale = which == 0 ? 1.0 : 0.5},
                  [](double) { return SimulatedHand{}; });
    ASSERT_TRUE(rig.until(PenPhase::ready));
    rig.tick(), rig.tick();
    // One short force, before it moves the pen.
    rig.tick({0, 0, 1});
    rig.tick(), rig.tick();
    for (const ForcePacket& packet : rig.seen) units[which] = std::max(units[which], std::abs(packet.motors[0]));
  }
  EXPECT_GT(units[0], 100);
  EXPECT_NEAR(units[1], 2 * units[0], 2);
}

TEST(FalconPenTest, too_long_a_force_keeps_its_direction) {
  FalconRig rig({.runs = true, .homed = true}, {}, circling);
  ASSERT_TRUE(rig.until(PenPhase::ready));
  for (int i = 0; i < 20; ++i) rig.tick({300, 200, -100});
  int largest = 0;
  for (const std::int16_t motor : rig.seen.back().motors) largest = std::max(largest, std::abs(motor));
  EXPECT_LE(largest, kMaxUnits);
  EXPECT_GT(largest, kMaxUnits - 2);
  EXPECT_GT(rig.device.newton().normalized().dot(Eigen::Vector3d(3, 2, -1).normalized()), 0.9999);
  for (int i = 0; i < 10; ++i) rig.tick({std::nan(""), 0, 0});
  EXPECT_EQ(rig.seen.back().motors, (std::array<std::int16_t, 3>{}));
}

TEST(FalconPenTest, there_is_no_force_before_it_is_homed) {
  FalconRig rig;
  for (int i = 0; i < 60'000; ++i) {
    const PenReading reading = rig.tick({5, 5, 5});
    if (reading.phase == PenPhase::ready) break;
    for (const ForcePacket& packet : rig.seen) ASSERT_EQ(packet.motors, (std::array<std::int16_t, 3>{}));
    rig.seen.clear();
  }
}

TEST(FalconPenTest, buttons_come_through) {
  FalconRig rig({.runs = true, .homed = true}, {}, [](double seconds) {
    SimulatedHand hand;
    hand.buttons = seconds > 1 ? 5 : 0;
    return hand;
  });
  ASSERT_TRUE(rig.until(PenPhase::ready));
  EXPECT_EQ(rig.tick().buttons, 0u);
  for (int i = 0; i < 1000; ++i) rig.tick();
  EXPECT_EQ(rig.tick().buttons, 5u);
}

TEST(FalconPenTest, short_and_merged_packets_are_put_together) {
  for (const std::size_t piece : {1u, 5u, 15u, 17u, 62u}) {
    FalconRig rig({.runs = true, .homed = true, .piece_bytes = piece}, {}, circling);
    ASSERT_TRUE(rig.until(PenPhase::ready)) << piece;
    for (int i = 0; i < 200; ++i) rig.tick();
    EXPECT_EQ(rig.bad, 0u) << piece;
    EXPECT_EQ(rig.lost, 0u) << piece;
    EXPECT_GT(rig.replies, 150u) << piece;
  }
}

TEST(FalconPenTest, merged_answers_count_as_one_pose) {
  FalconRig rig({.runs = true, .homed = true}, {}, circling);
  ASSERT_TRUE(rig.until(PenPhase::ready));
  rig.tick();
  rig.cable.hold(true, false);
  rig.tick(), rig.tick();
  rig.cable.hold(false, false);
  std::uint32_t most = 0;
  for (int i = 0; i < 5; ++i) most = std::max(most, rig.tick().replies);
  EXPECT_GE(most, 2u);
  EXPECT_EQ(rig.bad, 0u);
}

TEST(FalconPenTest, answers_to_nobodys_question_are_left) {
  FalconRig rig({.runs = true, .homed = true}, {}, circling);
  // Of an earlier host: they stand at another place.
  const PacketBytes old = encode(PosePacket{.encoders = {900, -900, 300}, .homed = kAllHomed});
  for (int i = 0; i < 3; ++i) rig.device.inject(0, old);
  ASSERT_TRUE(rig.until(PenPhase::ready));
  for (int i = 0; i < 100; ++i) {
    rig.tick();
    if (rig.last.measured_ns != 0) {
      ASSERT_LT((rig.last.position_mm - rig.device.pen().position_mm()).norm(), 0.3);
    }
  }
}

TEST(FalconPenTest, an_answer_without_a_question_is_no_pose) {
  FalconRig rig({.runs = true, .homed = true}, {}, circling);
  ASSERT_TRUE(rig.until(PenPhase::ready));
  const auto quiet_tick = [&] {
    rig.clock.advance_ns(kTickNs);
    return rig.pen.read(rig.clock.now_ns());
  };
  for (int i = 0; i < 10; ++i) (void)quiet_tick();
  rig.device.inject(rig.clock.now_ns(), encode(PosePacket{.encoders = {-500, -500, -500}, .homed = kAllHomed}));
  for (int i = 0; i < 10; ++i) {
    const PenReading reading = quiet_tick();
    EXPECT_FALSE(reading.fresh);
    EXPECT_EQ(reading.replies, 0u);
  }
}

TEST(FalconPenTest, answers_of_its_start_are_not_taken_for_later_ones) {
  FalconRig rig({.runs = true, .homed = true}, {}, circling);
  rig.device.answer_late_by(100'000'000);
  while (rig.tick().phase == PenPhase::setting_up)
    if (rig.seen.size() > 3) rig.device.answer_late_by(0);
  const std::size_t asked_by_start = rig.seen.size();
  EXPECT_GT(asked_by_start, 3u);
  const std::uint32_t before = rig.replies;
  for (int i = 0; i < 300; ++i) {
    rig.tick();
    ASSERT_LE(rig.replies - before, rig.seen.size() - asked_by_start);
  }
  EXPECT_GT(rig.replies, before + 250);
  EXPECT_EQ(rig.lost, 0u);
}

TEST(FalconPenTest, losing_its_marks_takes_its_forces) {
  FalconRig rig({.runs = true, .homed = true}, {}, [](double) { return SimulatedHand{}; });
  ASSERT_TRUE(rig.until(PenPhase::ready));
  for (int i = 0; i < 20; ++i) rig.tick({0.1, 0, 0});
  EXPECT_NE(rig.seen.back().motors, (std::array<std::int16_t, 3>{}));
  rig.device.lose_homing();
  for (int i = 0; i < 5; ++i) rig.tick({0.1, 0, 0});
  EXPECT_EQ(rig.tick({0.1, 0, 0}).phase, PenPhase::homing);
  EXPECT_EQ(rig.seen.back().motors, (std::array<std::int16_t, 3>{}));
  EXPECT_EQ(rig.seen.back().lights, kRed);
}

TEST(FalconPenTest, a_bus_that_takes_nothing_is_stuck_until_it_does) {
  FalconRig rig;
  while (rig.tick().phase != PenPhase::ready) ASSERT_FALSE(rig.pen.is_stuck(rig.clock.now_ns()));
  for (int i = 0; i < 100; ++i) {
    rig.tick({1, 0, 0});
    ASSERT_FALSE(rig.pen.is_stuck(rig.clock.now_ns()));
  }
  rig.cable.hold(false, true);
  int ticks = 0;
  for (; ticks < 100 && !rig.pen.is_stuck(rig.clock.now_ns()); ++ticks) rig.tick({1, 0, 0});
  EXPECT_GT(ticks, 9);
  EXPECT_LT(ticks, 14);
  rig.cable.hold(false, false);
  rig.tick(), rig.tick();
  EXPECT_FALSE(rig.pen.is_stuck(rig.clock.now_ns()));
}

TEST(FalconPenTest, lost_answers_are_counted_and_it_goes_on) {
  FalconRig rig({.runs = true, .homed = true}, {}, circling);
  ASSERT_TRUE(rig.until(PenPhase::ready));
  for (int i = 0; i < 50; ++i) rig.tick();
  rig.device.lose_next_answers(9);
  for (int i = 0; i < 200; ++i) rig.tick();
  EXPECT_EQ(rig.lost, 9u);
  const std::uint32_t before = rig.replies;
  for (int i = 0; i < 100; ++i) rig.tick();
  EXPECT_GT(rig.replies, before + 80);
}

TEST(FalconPenTest, a_late_device_gets_no_queue_of_forces_but_gets_a_zero) {
  FalconRig rig({.runs = true, .homed = true}, {}, circling);
  ASSERT_TRUE(rig.until(PenPhase::ready));
  for (int i = 0; i < 50; ++i) rig.tick({1, 0, 0});
  rig.device.answer_late_by(15'000'000);
  std::size_t before = rig.seen.size();
  for (int i = 0; i < 10; ++i) rig.tick({1, 0, 0});
  EXPECT_LE(rig.seen.size(), before + 4);
  before = rig.seen.size();
  rig.tick(), rig.tick();
  ASSERT_GT(rig.seen.size(), before);
  EXPECT_EQ(rig.seen.back().motors, (std::array<std::int16_t, 3>{}));
}

TEST(FalconPenTest, a_force_that_is_too_old_when_the_bus_is_free_is_dropped) {
  FalconRig rig({.runs = true, .homed = true}, {}, circling);
  ASSERT_TRUE(rig.until(PenPhase::ready));
  for (int i = 0; i < 50; ++i) rig.tick({1, 0, 0});
  rig.cable.hold(false, true);
  for (int i = 0; i < 8; ++i) rig.tick({3, 0, 0});
  for (int i = 0; i < 4; ++i) rig.tick();
  rig.seen.clear();
  rig.cable.hold(false, false);
  for (int i = 0; i < 4; ++i) rig.tick();
  ASSERT_FALSE(rig.seen.empty());
  for (const ForcePacket& packet : rig.seen) EXPECT_EQ(packet.motors, (std::array<std::int16_t, 3>{}));
}

TEST(FalconPenTest, without_firmware_it_says_so_and_sends_nothing) {
  FalconRig rig({}, {});
  for (int i = 0; i < 3000; ++i) rig.tick({1, 1, 1});
  const PenReading reading = rig.tick();
  EXPECT_EQ(reading.phase, PenPhase::setting_up);
  EXPECT_EQ(reading.trouble, PenTrouble::refused);
  EXPECT_THAT(rig.pen.advice(), testing::HasSubstr("set haptic_pen.firmware"));
  EXPECT_TRUE(rig.seen.empty());
}

TEST(FalconPenTest, a_deaf_device_is_asked_three_times_then_named) {
  FalconRig rig;
  rig.device.be_deaf(true);
  for (int i = 0; i < 15'000; ++i) rig.tick();
  EXPECT_EQ(rig.tick().trouble, PenTrouble::refused);
  EXPECT_EQ(rig.pen.advice(), "the Falcon doesn't answer: is its power supply plugged in?");
}

TEST(FalconPenTest, a_damaged_upload_is_repeated) {
  FalconRig rig;
  rig.device.damage_echo(5000);
  bool said = false;
  for (int i = 0; i < 30'000; ++i) {
    rig.tick();
    if (rig.pen.advice().find("with errors") == std::string::npos) continue;
    if (!std::exchange(said, true)) {
      EXPECT_THAT(rig.pen.advice(), testing::HasSubstr("(attempt 2 of 3)"));
      rig.device.damage_echo(static_cast<std::size_t>(-1));
    }
  }
  EXPECT_TRUE(said);
  EXPECT_TRUE(rig.device.runs());
}

TEST(FalconPenTest, firmware_of_another_kind_is_refused_by_the_loader) {
  // The file's check stands before this; the device refuses it as well.
  std::vector<std::byte> wrong = pretended_firmware(500);
  wrong[0] = std::byte{0x55};
  FalconRig rig({}, {.firmware = wrong});
  for (int i = 0; i < 30'000; ++i) rig.tick();
  EXPECT_EQ(rig.tick().trouble, PenTrouble::refused);
  EXPECT_FALSE(rig.device.runs());
  EXPECT_THAT(rig.pen.advice(), testing::HasSubstr("stopped taking the firmware"));
}

TEST(FalconPenTest, an_unplug_at_any_byte_ends_it) {
  for (std::size_t bytes = 1; bytes < 200; bytes += 3) {
    FalconRig rig({.runs = true, .homed = true}, {}, circling);
    rig.cable.unplug_after_sent(bytes);
    ASSERT_TRUE(rig.until(PenPhase::absent)) << bytes;
    EXPECT_TRUE(rig.pen.gone());
    EXPECT_EQ(rig.tick({1, 0, 0}).trouble, PenTrouble::io_error);
  }
  // And within the boot sequence.
  for (const std::size_t bytes : {2u, 17u, 33u, 40u, 300u, 5000u, 8042u}) {
    FalconRig rig;
    rig.cable.unplug_after_sent(bytes);
    ASSERT_TRUE(rig.until(PenPhase::absent)) << bytes;
  }
}

TEST(FalconPenTest, losing_its_power_takes_its_forces) {
  FalconRig rig({.runs = true, .homed = true}, {}, circling);
  ASSERT_TRUE(rig.until(PenPhase::ready));
  haptics::HapticLoop loop({}, rig.pen.limits());
  const auto step = [&](bool rearm) {
    haptics::HapticTick tick;
    for (int part = 0; part < 4; ++part) rig.clock.advance_ns(kTickNs / 4), rig.cable.run();
    tick.now_ns = rig.clock.now_ns();
    tick.pen = rig.pen.read(tick.now_ns);
    tick.rearm = rearm;
    const haptics::HapticAnswer answer = loop.step(tick);
    rig.pen.send(tick.now_ns, answer.command);
    return answer.safety.record.phase;
  };
  for (int i = 0; i < 50; ++i) (void)step(false);
  EXPECT_EQ(step(true), haptics::SafetyPhase::armed);
  for (int i = 0; i < 500; ++i) ASSERT_EQ(step(false), haptics::SafetyPhase::armed) << i;
  rig.device.lose_power();
  for (int i = 0; i < 30; ++i) (void)step(false);
  EXPECT_EQ(step(false), haptics::SafetyPhase::latched);
}

TEST(FalconPenTest, a_silent_host_leaves_either_the_last_force_or_none) {
  for (const Silence silence : {Silence::holds_last_force, Silence::lets_go}) {
    FalconRig rig({.silence = silence, .runs = true, .homed = true}, {}, circling);
    ASSERT_TRUE(rig.until(PenPhase::ready));
    for (int i = 0; i < 50; ++i) rig.tick({2, 0, 0});
    std::array<std::byte, port::kUsbPacketBytes> packet{};
    for (int i = 0; i < 400; ++i) {
      rig.clock.advance_ns(kTickNs);
      (void)rig.port->read(packet);
    }
    EXPECT_EQ(rig.device.newton().norm() > 1, silence == Silence::holds_last_force);
    EXPECT_EQ(rig.device.pen().applied_newton().norm() > 1, silence == Silence::holds_last_force);
  }
}

}  // namespace
}  // namespace prismesh::drivers::haptic_pen::falcon

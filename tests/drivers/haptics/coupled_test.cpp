// Hand, pen, loop and shells together, in virtual time.
#include <cmath>
#include <iostream>

#include <gtest/gtest.h>

#include "drivers/haptics/stiffness.h"
#include "tests/drivers/haptics/haptic_rig.h"

namespace prismesh::drivers::haptics {
namespace {

using haptic_pen::SimulatedHand;
using haptic_pen::SimulatedPenOptions;

std::unique_ptr<HapticField> wall() {
  return test::make_field([](const Eigen::Vector3d& at) { return std::abs(at.z()); }, {.fine_count = 64, .coarse_count = 60});
}

/// A hand that only pushes, without damping of its own: the worst one for stability.
SimulatedHand pushing(double newton) { return {.stiffness_newton_m = 0, .damping_newton_s_m = 0, .push_newton = {0, 0, -newton}}; }

struct WallFigures {
  double swing_mm = 0;     ///< of the last second
  double motor_joule = 0;  ///< that the motors gave in the last second
  double newton = 0;       ///< of the wall at the end
};

/// Pushes on a wall for some seconds with a multiple of the stiffness bound.
WallFigures push_on_a_wall(double times_the_bound) {
  HapticRig rig(
      SimulatedPenOptions{},
      [](double seconds) {
        SimulatedHand hand = pushing(1);
        if (seconds < 1.2) hand = {.goal_mm = {0, 0, 2}};
        return hand;
      },
      wall());
  rig.feel.damping_newton_s_m = 0;
  const double bound = max_stiffness_newton_m(rig.pen.limits(), HapticRig::kTickNs);
  // The loop lowers its own stiffness; the test scales what it asks for.
  rig.feel.stiffness_newton_m = bound;
  rig.arm();
  double low = 1e9, high = -1e9, joule = 0;
  for (int i = 0; i < 5000; ++i) {
    rig.clock.advance_ns(HapticRig::kTickNs);
    const std::int64_t now = rig.clock.now_ns();
    HapticTick tick;
    tick.now_ns = now;
    tick.pen = rig.pen.read(now);
    rig.field->time_ns = now;
    tick.sources.field = rig.field.get();
    tick.feel = rig.feel;
    const HapticAnswer answer = rig.loop.step(tick);
    rig.pen.send(now, {times_the_bound * answer.parts[0].newton, now + 3 * HapticRig::kTickNs});
    if (i == 4000) joule = rig.pen.motor_joule();
    if (i < 4000) continue;
    low = std::min(low, rig.pen.position_mm().z());
    high = std::max(high, rig.pen.position_mm().z());
  }
  return {high - low, rig.pen.motor_joule() - joule, rig.pen.applied_newton().z()};
}

TEST(coupled, a_wall_at_the_stiffness_bound_is_stable_and_passive) {
  for (const double times : {0.25, 0.5, 1.0}) {
    const WallFigures figures = push_on_a_wall(times);
    EXPECT_LT(figures.swing_mm, 0.05) << times;
    EXPECT_LT(figures.motor_joule, 1e-5) << times;
    EXPECT_NEAR(figures.newton, 1, 0.06) << "it holds the hand, but for its friction";
    std::cout << times << " of the bound: swings by " << figures.swing_mm << " mm, motors give " << figures.motor_joule
              << " J in a second\n";
  }
}

TEST(coupled, a_wall_of_four_times_the_bound_swings_for_ever) {
  const WallFigures figures = push_on_a_wall(4);
  EXPECT_GT(figures.swing_mm, 0.5);
  EXPECT_GT(figures.motor_joule, 1e-3);
  std::cout << "4 of the bound: swings by " << figures.swing_mm << " mm, motors give " << figures.motor_joule << " J in a second\n";
}

TEST(coupled, the_loop_keeps_to_the_bound_whatever_is_asked_for) {
  HapticRig rig(
      SimulatedPenOptions{},
      [](double seconds) {
        return seconds < 1.2 ? SimulatedHand{.goal_mm = {0, 0, 2}} : pushing(1);
      },
      wall());
  rig.feel.stiffness_newton_m = 10'000;
  EXPECT_EQ(rig.arm().stiffness_newton_m, max_stiffness_newton_m(rig.pen.limits(), HapticRig::kTickNs));
  rig.run_ms(3000);
  double low = 1e9, high = -1e9;
  for (int i = 0; i < 1000; ++i) {
    rig.tick();
    low = std::min(low, rig.pen.position_mm().z());
    high = std::max(high, rig.pen.position_mm().z());
  }
  EXPECT_LT(high - low, 0.05);
  EXPECT_TRUE(rig.kept) << rig.checker.fault();
}

/// Pushes, slides with a tremor, and lets go.
SimulatedHand scripted_hand(double seconds) {
  if (seconds < 1.5) return {.goal_mm = {0, 0, 3}};
  if (seconds < 2.5) return {.goal_mm = {0, 0, 3 - 8 * (seconds - 1.5)}};
  if (seconds < 4.5) return {.goal_mm = {4 * (seconds - 2.5), 0.4 * std::sin(57 * seconds), -5}};
  if (seconds < 5.5) return {.stiffness_newton_m = 0, .damping_newton_s_m = 0};
  return {.goal_mm = {0, 0, 6}};
}

TEST(coupled, a_scripted_hand_feels_the_wall_slides_on_it_and_the_record_is_clean) {
  for (const std::int64_t jitter_ns : {0, 1'200'000}) {
    HapticRig rig({.jitter_ns = jitter_ns}, scripted_hand, wall());
    rig.arm();
    double max_newton = 0;
    int touching = 0;
    for (int i = 0; i < 5500; ++i) {
      const HapticAnswer answer = rig.tick();
      max_newton = std::max(max_newton, answer.command.newton.norm());
      touching += answer.contact.touching;
      if (answer.contact.touching) {
        EXPECT_GT(answer.contact.proxy_mm.z(), 0);
      }
      ASSERT_EQ(answer.safety.record.phase, SafetyPhase::armed) << static_cast<int>(answer.safety.record.fault) << " at " << i;
    }
    EXPECT_GT(touching, 2000);
    EXPECT_GT(max_newton, 0.5);
    EXPECT_TRUE(rig.kept) << rig.checker.fault();
    // The motors' true work stays within the limit too.
    EXPECT_LT(rig.pen.motor_joule(), 0.020);
  }
}

TEST(coupled, a_stall_of_the_loop_or_a_lost_line_ends_the_force_and_latches) {
  for (const int what : {0, 1, 2}) {
    HapticRig rig(SimulatedPenOptions{}, scripted_hand, wall());
    rig.arm();
    const HapticAnswer pressing = rig.run_ms(2200);
    ASSERT_GT(pressing.command.newton.norm(), 0.4);
    HapticAnswer answer;
    if (what == 0) {
      answer = rig.tick(50 * HapticRig::kTickNs);
      EXPECT_EQ(answer.safety.record.fault, SafetyFault::late_tick);
    } else if (what == 1) {
      rig.pen.lose_next_replies(1);
      rig.tick();
      answer = rig.tick();
      EXPECT_EQ(answer.safety.record.fault, SafetyFault::lost_reply);
    } else {
      rig.pen.unplug(true);
      answer = rig.tick();
      EXPECT_EQ(answer.safety.record.fault, SafetyFault::io_error);
      rig.pen.unplug(false);
    }
    EXPECT_EQ(answer.command.newton.norm(), 0);
    EXPECT_EQ(rig.run_ms(3000).safety.record.phase, SafetyPhase::latched);
    rig.rearm = true;
    rig.tick();
    EXPECT_EQ(rig.run_ms(10).safety.record.phase, SafetyPhase::armed);
    EXPECT_TRUE(rig.kept) << rig.checker.fault();
  }
}

TEST(coupled, an_old_field_fades_away_under_the_pen) {
  HapticRig rig(
      SimulatedPenOptions{},
      [](double seconds) {
        return seconds < 1.2 ? SimulatedHand{.goal_mm = {0, 0, 2}} : SimulatedHand{.goal_mm = {0, 0, -3}};
      },
      wall());
  rig.arm();
  ASSERT_GT(rig.run_ms(1000).command.newton.z(), 0.4);
  rig.field_is_fresh = false;
  ASSERT_GT(rig.run_ms(100).command.newton.z(), 0.4);
  rig.run_ms(50);
  EXPECT_LT(rig.run_ms(20).command.newton.norm(), 0.1) << "damping only";
  EXPECT_TRUE(rig.kept) << rig.checker.fault();
}

TEST(coupled, without_a_pen_there_is_no_force_and_no_latch) {
  HapticLoop loop({}, {});
  HapticTick tick;
  for (int i = 0; i < 100; ++i) {
    tick.now_ns += HapticRig::kTickNs;
    tick.rearm = i % 2 == 0;
    const HapticAnswer answer = loop.step(tick);
    EXPECT_EQ(answer.command.newton.norm(), 0);
    EXPECT_EQ(answer.safety.record.phase, SafetyPhase::disarmed);
  }
}

/// A disarmed pen that was pushed through a sheet is on the other side then: it can be armed there, and is held on that side.
TEST(coupled, a_pen_without_force_passes_and_can_be_armed_on_the_other_side) {
  double goal_mm = 5;
  HapticRig rig(
      {},
      [&](double) {
        haptic_pen::SimulatedHand hand;
        hand.goal_mm = {0, 0, goal_mm};
        return hand;
      },
      test::make_field([](const Eigen::Vector3d& at) { return std::abs(at.z()); }, {}));
  EXPECT_FALSE(rig.run_ms(200).contact.touching);
  goal_mm = 0.2;
  EXPECT_TRUE(rig.run_ms(400).contact.touching) << "it touches the sheet that it is in";
  goal_mm = -5;
  HapticAnswer answer = rig.run_ms(600);
  EXPECT_FALSE(answer.contact.touching);
  EXPECT_LT(answer.contact.proxy_mm.z(), -4);
  answer = rig.arm();
  EXPECT_EQ(answer.safety.record.phase, SafetyPhase::armed);
  goal_mm = 3;
  answer = rig.run_ms(1500);
  EXPECT_TRUE(answer.contact.touching);
  EXPECT_LT(answer.contact.proxy_mm.z(), 0) << "armed, it is held on its side";
  EXPECT_TRUE(rig.kept) << rig.checker.fault();
}

}  // namespace
}  // namespace prismesh::drivers::haptics

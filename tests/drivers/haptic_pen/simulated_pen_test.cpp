// The simulated pen against the equations of its model.
#include "drivers/haptic_pen/simulated_pen.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/clock.h"

namespace prismesh::drivers::haptic_pen {
namespace {

constexpr std::int64_t kTickNs = 1'000'000;

/// Ticks of 1 ms that command a force.
struct PenBench {
  explicit PenBench(const SimulatedPenOptions& options, HandSource hand) : pen(options, std::move(hand)) { clock.advance_ns(kTickNs); }
  PenReading tick() {
    const std::int64_t now = clock.now_ns();
    const PenReading reading = pen.read(now);
    if (commanding) pen.send(now, {force, now + 3 * kTickNs});
    clock.advance_ns(kTickNs);
    return reading;
  }
  PenReading run(int ticks) {
    PenReading reading;
    for (int i = 0; i < ticks; ++i) {
      const PenReading next = tick();
      if (next.fresh || !next.replies) reading = next;
    }
    return reading;
  }
  ManualClock clock;
  SimulatedPen pen;
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  bool commanding = true;
};

SimulatedHand no_hand(double) { return {.stiffness_newton_m = 0, .damping_newton_s_m = 0}; }

TEST(simulated_pen, falls_to_its_end_speed_under_a_force) {
  PenBench bench({.damping_newton_s_m = 2, .friction_newton = 0.1, .quantum_mm = 0, .workspace_mm = 1000}, no_hand);
  bench.force = {0.3, 0, 0};
  bench.run(1000);
  EXPECT_NEAR(bench.pen.velocity_mm_s().x(), (0.3 - 0.1) / 2 * 1000, 0.5) << "(force - friction) / damping";
}

TEST(simulated_pen, a_force_below_its_friction_does_not_move_it) {
  PenBench bench({.friction_newton = 0.1, .quantum_mm = 0}, no_hand);
  bench.force = {0, 0.099, 0};
  bench.run(1000);
  EXPECT_EQ(bench.pen.position_mm().norm(), 0);
  bench.force = {0, 0.11, 0};
  bench.run(1000);
  EXPECT_GT(bench.pen.position_mm().y(), 0.1);
}

TEST(simulated_pen, loses_energy_by_itself) {
  PenBench bench({.quantum_mm = 0}, [](double seconds) {
    SimulatedHand hand = no_hand(seconds);
    if (seconds < 0.05) hand.push_newton = {3, 0, 0};
    return hand;
  });
  bench.run(60);
  double last = bench.pen.kinetic_joule();
  EXPECT_GT(last, 1e-3);
  for (int i = 0; i < 500; ++i) {
    bench.tick();
    ASSERT_LE(bench.pen.kinetic_joule(), last + 1e-15);
    last = bench.pen.kinetic_joule();
  }
  EXPECT_EQ(last, 0) << "friction stops it";
}

TEST(simulated_pen, follows_a_hand_that_pushes_slides_and_trembles_and_stays_when_it_lets_go) {
  PenBench bench({}, [](double seconds) {
    SimulatedHand hand;
    if (seconds < 1)
      hand.goal_mm = {0, -5 * seconds, 0};
    else if (seconds < 2)
      hand.goal_mm = {10 * (seconds - 1), -5, 0};
    else if (seconds < 3)
      hand.goal_mm = {10 + 0.5 * std::sin(2 * 3.14159265 * 9 * seconds), -5, 0};
    else
      hand = no_hand(seconds);
    return hand;
  });
  bench.run(1000);
  EXPECT_NEAR(bench.pen.position_mm().y(), -5, 0.5);
  bench.run(1000);
  EXPECT_NEAR(bench.pen.position_mm().x(), 10, 0.5);
  bench.run(500);
  double low = 1e9, high = -1e9;
  for (int i = 0; i < 400; ++i) {
    bench.tick();
    low = std::min(low, bench.pen.position_mm().x());
    high = std::max(high, bench.pen.position_mm().x());
  }
  EXPECT_NEAR(high - low, 1, 0.6) << "a tremor of 9 Hz";
  bench.run(600);
  const Eigen::Vector3d left = bench.pen.position_mm();
  bench.run(500);
  EXPECT_EQ((bench.pen.position_mm() - left).norm(), 0);
}

TEST(simulated_pen, reports_the_place_at_the_request_rounded_to_its_resolution) {
  PenBench bench({.quantum_mm = 0.5, .pose_delay_ns = 300'000}, [](double seconds) {
    return SimulatedHand{.goal_mm = {20 * seconds, 0, 0}};
  });
  bench.run(500);
  const double at_request = bench.pen.position_mm().x();
  const std::int64_t asked_ns = bench.clock.now_ns() - kTickNs;
  const PenReading reading = bench.tick();
  EXPECT_TRUE(reading.fresh);
  EXPECT_EQ(reading.pose.measured_ns, asked_ns);
  EXPECT_EQ(std::fmod(reading.pose.position_mm.x(), 0.5), 0);
  EXPECT_NEAR(reading.pose.position_mm.x(), at_request, 0.25 + 0.1);
}

TEST(simulated_pen, jitter_merges_replies_and_loses_none) {
  PenBench bench({.pose_delay_ns = 200'000, .jitter_ns = 1'500'000}, no_hand);
  int none = 0, merged = 0;
  std::uint32_t replies = 0;
  std::int64_t last_ns = 0;
  for (int i = 0; i < 1000; ++i) {
    const PenReading reading = bench.tick();
    none += reading.replies == 0;
    merged += reading.replies > 1;
    replies += reading.replies;
    if (reading.fresh) {
      EXPECT_GT(reading.pose.measured_ns, last_ns);
      last_ns = reading.pose.measured_ns;
    }
    EXPECT_EQ(reading.lost_replies, 0U);
  }
  EXPECT_GT(none, 50);
  EXPECT_GT(merged, 50);
  EXPECT_GE(replies, 997U);
}

TEST(simulated_pen, reports_lost_replies_and_a_line_that_is_gone) {
  PenBench bench({}, no_hand);
  bench.run(10);
  bench.pen.lose_next_replies(2);
  std::uint32_t lost = 0;
  for (int i = 0; i < 5; ++i) lost += bench.tick().lost_replies;
  EXPECT_EQ(lost, 2U);
  bench.pen.unplug(true);
  const PenReading reading = bench.tick();
  EXPECT_EQ(reading.phase, PenPhase::absent);
  EXPECT_EQ(reading.trouble, PenTrouble::io_error);
}

TEST(simulated_pen, a_command_ends_by_itself) {
  PenBench bench({}, no_hand);
  bench.force = {1, 0, 0};
  bench.run(10);
  EXPECT_EQ(bench.pen.applied_newton().x(), 1);
  bench.commanding = false;
  bench.run(2);
  EXPECT_EQ(bench.pen.applied_newton().x(), 1);
  bench.run(3);
  EXPECT_EQ(bench.pen.applied_newton().x(), 0);
}

TEST(simulated_pen, stays_within_its_stops) {
  PenBench bench({.workspace_mm = 20}, no_hand);
  bench.force = {5, -5, 5};
  bench.run(2000);
  EXPECT_EQ(bench.pen.position_mm(), Eigen::Vector3d(20, -20, 20));
}

TEST(simulated_pen, states_its_limits) {
  const SimulatedPen pen({.damping_newton_s_m = 1.5, .pose_delay_ns = 300'000, .force_delay_ns = 200'000}, no_hand);
  EXPECT_EQ(pen.limits().damping_newton_s_m, 1.5);
  EXPECT_EQ(pen.limits().delay_ns, 1'200'000) << "its answers wait for the next tick";
  EXPECT_EQ(pen.limits().max_newton, 8);
}

}  // namespace
}  // namespace prismesh::drivers::haptic_pen

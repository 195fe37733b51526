#include "drivers/prism_servo/mask_control.h"

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/eye_tracker/head_motion.h"
#include "tests/drivers/prism_servo/mask_rig.h"

namespace prismesh::drivers::prism_servo {
namespace {

using eye_tracker::HeadMotion;
using eye_tracker::MotionKind;

/// Moves slowly to the right and back, up to `reach`.
std::function<Eigen::Vector3d(double)> oscillating(double reach_mm, double period_s) {
  return [=](double seconds) { return Eigen::Vector3d(reach_mm * std::sin(2 * M_PI * seconds / period_s), 0, 650); };
}

/// Still until a time, then at constant speed to the right.
std::function<Eigen::Vector3d(double)> walk_right(double from_s, double mm_s, double start_mm = 0, double end_mm = 1e9) {
  return [=](double seconds) { return Eigen::Vector3d(std::min(end_mm, start_mm + mm_s * std::max(0.0, seconds - from_s)), 0, 650); };
}

MaskRigSettings little_travel(double travel_mm) {
  MaskRigSettings settings;
  settings.limits.travel_mm = settings.servo.driver.travel_mm = travel_mm;
  settings.servo.simulated.start_mm = 0.2 * travel_mm;
  return settings;
}

TEST(mask_control, homes_then_follows_and_then_allows_stereo) {
  MaskRig rig;
  std::vector<MaskPhase> phases;
  rig.each_tick = [&](const auto&, const MaskControl::Output& out) {
    if (phases.empty() || phases.back() != out.state.phase) phases.push_back(out.state.phase);
    if (out.state.phase != MaskPhase::following) {
      EXPECT_FALSE(out.state.stereo_allowed);
    }
  };
  const std::int64_t ms = rig.run_until_stereo(3'000);
  EXPECT_GT(ms, 0);
  EXPECT_LT(ms, 1'500);
  EXPECT_THAT(phases, testing::ElementsAre(MaskPhase::absent, MaskPhase::homing, MaskPhase::following));
  EXPECT_NEAR(rig.mask().mask_mm(), 0, 0.01);
}

TEST(mask_control, the_mask_follows_the_ideal_position) {
  MaskRig rig;
  rig.head = oscillating(120, 3);  // up to 250 mm/s
  ASSERT_GE(rig.run_until_stereo(), 0);
  double worst = 0;
  rig.each_tick = [&](const auto&, const auto&) { worst = std::max(worst, std::abs(rig.mask().motor_mm() - rig.ideal_mm())); };
  rig.run_for(9'000 * kMs);
  EXPECT_LT(worst, 0.02) << "of 0.28 mm that are a pixel";
}

TEST(mask_control, compensates_the_lag) {
  MaskRig rig;
  rig.head = oscillating(120, 3);
  ASSERT_GE(rig.run_until_stereo(), 0);
  double lead = 0;
  int ticks = 0;
  rig.each_tick = [&](const MaskControl::Input& input, const MaskControl::Output& out) {
    const double velocity = input.head.velocity_mm_s.x();
    if (std::abs(velocity) < 100) return;
    const double now =
        display::mask_position_mm({}, eye_tracker::predict(input.head, input.now_ns)) - out.state.half_periods * rig.half_period_mm();
    lead += (out.goal_mm - now) / (0.00443 * velocity);
    ++ticks;
  };
  rig.run_for(3'000 * kMs);
  EXPECT_NEAR(lead / ticks, 0.020, 0.001) << "seconds: the servo's lag and a tick";
}

TEST(mask_control, the_published_state_predicts_the_mask) {
  MaskRig rig;
  rig.head = oscillating(120, 3);
  ASSERT_GE(rig.run_until_stereo(), 0);
  std::deque<std::pair<std::int64_t, double>> predicted;
  double worst = 0;
  rig.each_tick = [&](const MaskControl::Input& input, const MaskControl::Output& out) {
    predicted.emplace_back(input.now_ns + 40 * kMs, mask_position_at(out.state, input.now_ns + 40 * kMs));
    while (!predicted.empty() && predicted.front().first < rig.servo().clock().now_ns()) predicted.pop_front();
    // The rig has advanced by one tick.
    if (!predicted.empty() && predicted.front().first == rig.servo().clock().now_ns())
      worst = std::max(worst, std::abs(predicted.front().second - rig.mask().motor_mm()));
  };
  rig.run_for(6'000 * kMs);
  EXPECT_GT(worst, 0);
  EXPECT_LT(worst, 0.015);
}

TEST(mask_control, a_predicted_position_approaches_the_goal_with_the_lag) {
  MaskState state;
  state.time_ns = state.measured_ns = 1'000 * kMs;
  state.lag_ns = 20 * kMs;
  state.position_mm = 0.9;
  state.velocity_mm_s = 5;
  state.goal_mm = 1;
  EXPECT_NEAR(mask_position_at(state, 1'000 * kMs), 0.9, 1e-9);
  EXPECT_NEAR(mask_position_at(state, 1'020 * kMs), 1 - 0.1 * std::exp(-1), 1e-9);
  EXPECT_NEAR(mask_position_at(state, 1'100 * kMs), 1, 0.001);
  EXPECT_LE(mask_position_at(state, 1'100 * kMs), 1);
  state.goal_velocity_mm_s = 1;
  state.position_mm = 0.98;  // one lag behind the goal: moves parallel to it
  EXPECT_NEAR(mask_position_at(state, 1'050 * kMs), 1.03, 1e-9);
  EXPECT_NEAR(mask_position_at(state, 9'000 * kMs), 1.08, 1e-9) << "no further than 100 ms ahead";
  EXPECT_NEAR(mask_position_at(state, 0), 0.98, 1e-9);
  state.measured_ns = 0;
  EXPECT_EQ(mask_position_at(state, 1'100 * kMs), 0.98);
}

// --- moves back ---

TEST(mask_control, moves_back_by_half_a_period_at_the_end_of_the_travel) {
  MaskRig rig(little_travel(0.6));
  rig.head = walk_right(3.0, 100);
  ASSERT_GE(rig.run_until_stereo(), 0);
  std::vector<std::int32_t> halves;
  rig.each_tick = [&](const auto&, const MaskControl::Output& out) {
    if (halves.empty() || halves.back() != out.state.half_periods) halves.push_back(out.state.half_periods);
  };
  rig.run_for(5'000 * kMs);
  // 3.7 s at 100 mm/s: 370 mm, 1.64 mm of mask travel; a move every 0.28 mm from 0.54 mm on.
  EXPECT_THAT(halves, testing::ElementsAre(0, 1, 2, 3, 4));
}

TEST(mask_control, moves_back_by_whole_periods_only_if_set_so) {
  MaskRigSettings settings = little_travel(0.6);
  settings.limits.half_period_returns = false;
  MaskRig rig(settings);
  rig.head = walk_right(3.0, 100);
  ASSERT_GE(rig.run_until_stereo(), 0);
  rig.each_tick = [&](const auto&, const MaskControl::Output& out) { EXPECT_EQ(out.state.half_periods % 2, 0); };
  rig.run_for(5'000 * kMs);
  EXPECT_EQ(rig.state().half_periods, 4);
}

TEST(mask_control, a_head_at_the_border_does_not_cause_repeated_moves) {
  MaskRig rig(little_travel(0.6));
  const double border_mm = 0.9 * 0.6 / 0.004433;
  rig.head = [&](double seconds) { return Eigen::Vector3d(border_mm + 15 * std::sin(seconds * 3), 0, 650); };
  ASSERT_GE(rig.run_until_stereo(), 0);
  int moves = 0;
  std::int32_t before = rig.state().half_periods;
  rig.each_tick = [&](const auto&, const MaskControl::Output& out) {
    moves += out.state.half_periods != before ? 1 : 0;
    before = out.state.half_periods;
  };
  rig.run_for(30'000 * kMs);
  EXPECT_LE(moves, 1);
}

TEST(mask_control, a_move_back_waits_for_the_end_of_the_last_stereo_picture) {
  const MaskRigSettings settings = little_travel(0.6);
  MaskRig rig(settings);
  rig.head = walk_right(3.0, 100);
  ASSERT_GE(rig.run_until_stereo(), 0);
  int moves = 0;
  bool flew = false;
  rig.each_tick = [&](const MaskControl::Input& input, const MaskControl::Output& out) {
    const bool flies = out.state.phase == MaskPhase::flying_back;
    if (flies && !flew) {
      // A picture that lit up just before the announced time stays visible for one period of the display.
      const std::int64_t gone_ns = out.state.mono_from_ns + settings.limits.picture_ns;
      EXPECT_GE(input.now_ns, gone_ns);
      EXPECT_LT(input.now_ns, gone_ns + kTickNs) << "nor is it kept waiting";
      ++moves;
    }
    flew = flies;
  };
  rig.run_for(5'000 * kMs);
  EXPECT_GE(moves, 3);
}

TEST(mask_control, a_move_back_leaves_half_a_step_of_travel) {
  MaskRig rig(little_travel(0.6));
  const double place_mm = 0.54 + 0.75 * rig.half_period_mm();  // beyond the border by so much
  rig.head = walk_right(3.0, 2500, 0, place_mm / 0.004433);
  ASSERT_GE(rig.run_until_stereo(), 0);
  ASSERT_GE(rig.run_until(MaskPhase::flying_back), 0);
  rig.run_for(500 * kMs);
  EXPECT_NEAR(rig.ideal_mm() + rig.state().half_periods * rig.half_period_mm(), place_mm, 0.01);
  EXPECT_EQ(rig.state().half_periods, 2) << "one would only just be enough";
}

TEST(mask_control, the_goal_stops_at_the_end_of_the_travel) {
  MaskRigSettings settings = little_travel(0.6);
  settings.limits.return_notice_ns = 10'000 * kMs;  // no move back comes in time
  MaskRig rig(settings);
  rig.head = walk_right(3.0, 100);
  ASSERT_GE(rig.run_until_stereo(), 0);
  rig.run_for(4'000 * kMs);
  EXPECT_EQ(rig.state().goal_mm, 0.6);
  EXPECT_EQ(rig.state().goal_velocity_mm_s, 0) << "however the head moves";
}

/// Checks the conditions that must hold at all times.
class ConditionChecks {
 public:
  explicit ConditionChecks(MaskRig& rig, const MaskRigSettings& settings) : rig_(rig), settings_(settings) {}

  void check(const MaskControl::Input& input, const MaskControl::Output& out) {
    const MaskState& state = out.state;
    const MaskLimits& limits = settings_.limits;
    ASSERT_TRUE(std::isfinite(out.goal_mm) && std::isfinite(state.goal_velocity_mm_s) && std::isfinite(state.position_mm));
    ASSERT_LE(std::abs(out.goal_mm), limits.travel_mm + 1e-12);
    if (powered_ && out.powered) {
      ASSERT_LE(std::abs(out.goal_mm - goal_), limits.speed_mm_s * kTickNs * 1e-9 + 1e-9);
    }
    powered_ = out.powered;
    goal_ = out.goal_mm;
    const bool flying = state.phase == MaskPhase::flying_back;
    if (flying) {
      ASSERT_FALSE(state.stereo_allowed);
      ASSERT_GE(state.mono_until_ns, input.now_ns) << "still on its way";
      ++flying_ticks;
    }
    ASSERT_EQ(state.mono_from_ns == 0, state.mono_until_ns == 0);
    check_announced_end(input.now_ns, state);
    if (state.stereo_allowed && state.phase == MaskPhase::following) {
      const double ideal = display::mask_position_mm(settings_.optics, eye_tracker::predict(input.head, input.now_ns + input.servo_lag_ns));
      const double goal = std::clamp(ideal - state.half_periods * rig_.half_period_mm(), -limits.travel_mm, limits.travel_mm);
      ASSERT_NEAR(out.goal_mm, goal, 0.08) << "a new measurement may move the goal faster than the motor";
    }
    // Announcement: the state published `notice` ago already said that pictures shown now must be mono.
    history_.push_back({input.now_ns, state});
    while (history_.front().first < input.now_ns - limits.return_notice_ns) history_.pop_front();
    const MaskState& announced = history_.front().second;
    const bool announced_mono =
        !announced.stereo_allowed || (input.now_ns >= announced.mono_from_ns && input.now_ns < announced.mono_until_ns);
    if (flying && history_.front().first <= input.now_ns - limits.return_notice_ns + kTickNs) {
      ASSERT_TRUE(announced_mono) << "at " << input.now_ns / kMs << " ms the mask moves back without an announcement in time";
    }
  }
  int flying_ticks = 0;

 private:
  /// Stereo returns at the announced end of a move back; announced ends only move later, and in time.
  void check_announced_end(std::int64_t now_ns, const MaskState& state) {
    const MaskState before = std::exchange(before_, state);
    const std::int64_t notice_ns = settings_.limits.return_notice_ns;
    const bool flew = before.phase == MaskPhase::flying_back, flies = state.phase == MaskPhase::flying_back;
    if (flies && !flew) {
      ASSERT_LE(state.mono_until_ns, before.mono_until_ns + notice_ns / 4) << "a longer move than was announced";
    }
    if (flew && state.phase == MaskPhase::following) {
      ASSERT_GE(now_ns, before.mono_until_ns) << "stereo returns sooner than announced";
    }
    if (flew && flies && state.mono_until_ns > before.mono_until_ns) {
      ASSERT_GE(before.mono_until_ns - now_ns, notice_ns - kTickNs) << "a longer duration is announced too late";
    }
  }

  MaskRig& rig_;
  MaskRigSettings settings_;
  std::deque<std::pair<std::int64_t, MaskState>> history_;
  MaskState before_;
  double goal_ = 0;
  bool powered_ = false;
};

TEST(mask_control, keeps_its_conditions_for_minutes_of_any_motion) {
  int flying = 0;
  for (const double travel : {0.35, 0.6, 2.0}) {
    for (const MotionKind kind : {MotionKind::sway, MotionKind::turn, MotionKind::tour}) {
      for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const MaskRigSettings settings = little_travel(travel);
        MaskRig rig(settings);
        const HeadMotion motion(kind, seed, {40.0 * static_cast<double>(seed), 0, 650}, 1.25);
        rig.head = [&](double seconds) { return motion.between_eyes_mm(seconds); };
        ConditionChecks conditions(rig, settings);
        bool stuck = false;
        rig.each_tick = [&](const auto& in, const auto& out) {
          conditions.check(in, out);
          stuck = stuck || out.state.phase == MaskPhase::stuck;
        };
        rig.run_for(60'000 * kMs);
        flying += conditions.flying_ticks;
        EXPECT_FALSE(stuck) << "travel " << travel << ", motion " << static_cast<int>(kind) << ", seed " << seed;
        if (testing::Test::HasFatalFailure()) return;
      }
    }
  }
  EXPECT_GT(flying, 200);
}

TEST(mask_control, keeps_its_conditions_for_random_motion_up_to_500_mm_s) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const MaskRigSettings settings = little_travel(0.5);
    MaskRig rig(settings);
    // A point on a random path: a sum of waves with a total speed of max. 500 mm/s.
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> frequency(0.1, 0.8), phase(0, 6.28);
    std::vector<std::array<double, 3>> waves;
    for (int i = 0; i < 5; ++i) {
      const double pulse = 2 * M_PI * frequency(random);
      waves.push_back({100 / pulse, pulse, phase(random)});
    }
    rig.head = [waves](double seconds) {
      Eigen::Vector3d place(0, 0, 650);
      for (const auto& [reach, pulse, at] : waves) place.x() += reach * std::sin(pulse * seconds + at);
      return place;
    };
    ConditionChecks conditions(rig, settings);
    bool stuck = false;
    int stereo = 0, ticks = 0;
    rig.each_tick = [&](const auto& in, const MaskControl::Output& out) {
      conditions.check(in, out);
      stuck = stuck || out.state.phase == MaskPhase::stuck;
      ++ticks;
      const bool mono = in.now_ns >= out.state.mono_from_ns && in.now_ns < out.state.mono_until_ns;
      stereo += out.state.stereo_allowed && !mono ? 1 : 0;
    };
    rig.run_for(120'000 * kMs);
    EXPECT_FALSE(stuck);
    EXPECT_GT(conditions.flying_ticks, 50);
    EXPECT_GT(stereo, ticks / 2);
    if (testing::Test::HasFatalFailure()) return;
  }
}

TEST(mask_control, a_slow_motor_extends_mono_and_announces_it_in_time) {
  for (const std::int64_t notice_ms : {60, 200}) {
    MaskRigSettings settings = little_travel(0.6);
    settings.limits.half_period_returns = false;
    settings.limits.return_notice_ns = notice_ms * kMs;
    settings.servo.simulated.speed_mm_s = 3.6;  // the settings say 5
    settings.servo.simulated.lag_ms = 60;       // the settings say 15
    MaskRig rig(settings);
    rig.head = oscillating(300, 8);
    ConditionChecks conditions(rig, settings);
    bool stuck = false;
    rig.each_tick = [&](const auto& in, const MaskControl::Output& out) {
      conditions.check(in, out);
      stuck = stuck || out.state.phase == MaskPhase::stuck;
    };
    rig.run_for(40'000 * kMs);
    EXPECT_FALSE(stuck);
    EXPECT_GT(conditions.flying_ticks, 100);
  }
}

// --- eyes and motor lost ---

TEST(mask_control, freezes_and_parks_without_eyes) {
  MaskRig rig;
  rig.head = [](double) { return Eigen::Vector3d(100, 0, 650); };
  ASSERT_GE(rig.run_until_stereo(), 0);
  rig.eyes = false;
  EXPECT_THAT(rig.run_until(MaskPhase::frozen), testing::AllOf(testing::Ge(0), testing::Le(10)));
  EXPECT_FALSE(rig.state().stereo_allowed);
  const double stands = rig.output().goal_mm;
  rig.each_tick = [&](const auto&, const MaskControl::Output& out) {
    if (out.state.phase == MaskPhase::frozen) {
      EXPECT_EQ(out.goal_mm, stands);
    }
  };
  const std::int64_t ms = rig.run_until(MaskPhase::parking);
  EXPECT_GE(ms, 240);
  EXPECT_LE(ms, 260);
  EXPECT_GE(rig.run_until(MaskPhase::parked), 0);
  rig.run_for(50 * kMs);
  EXPECT_FALSE(rig.mask().torque());
  EXPECT_NEAR(rig.mask().mask_mm(), 0, MaskLimits{}.settle_mm + 0.005);
  rig.eyes = true;
  const std::int64_t back = rig.run_until_stereo();
  EXPECT_GT(back, 0);
  EXPECT_LT(back, 400);
}

TEST(mask_control, parks_at_once_when_the_picture_is_mono) {
  MaskRig rig;
  ASSERT_GE(rig.run_until_stereo(), 0);
  rig.eyes = false;
  ASSERT_GE(rig.run_until(MaskPhase::frozen), 0);
  rig.run_for(50 * kMs);
  rig.picture_mono = true;
  EXPECT_THAT(rig.run_until(MaskPhase::parking), testing::AllOf(testing::Ge(0), testing::Le(10)));
}

TEST(mask_control, measurements_that_stop_count_as_lost_eyes) {
  MaskRigSettings settings;
  settings.measure_every_ns = 300 * kMs;
  MaskRig rig(settings);
  ASSERT_GE(rig.run_until_stereo(), 0);
  EXPECT_THAT(rig.run_until(MaskPhase::frozen, 400), testing::AllOf(testing::Ge(0), testing::Le(300)));
}

TEST(mask_control, measurements_in_the_future_count_as_lost_eyes) {
  for (const std::int64_t ahead_ms : {99, 101, 5'000}) {
    MaskRigSettings settings;
    settings.measure_every_ns = kTickNs;
    settings.tracker_latency_ns = -ahead_ms * kMs;
    MaskRig rig(settings);
    EXPECT_EQ(rig.run_until_stereo(2'000) >= 0, ahead_ms < 100) << ahead_ms << " ms";
  }
}

TEST(mask_control, positions_that_arent_finite_count_as_lost_eyes) {
  MaskRig rig;
  ASSERT_GE(rig.run_until_stereo(), 0);
  rig.head = [](double) { return Eigen::Vector3d(std::nan(""), 0, 650); };
  EXPECT_THAT(rig.run_until(MaskPhase::frozen, 100), testing::AllOf(testing::Ge(0), testing::Le(30)));
}

TEST(mask_control, torque_starts_at_the_motors_position) {
  for (const double place : {-1.9, -0.4, 1.5}) {
    MaskRigSettings settings;
    settings.servo.simulated.start_mm = place;
    MaskRig rig(settings);
    while (!rig.output().powered) rig.tick();
    EXPECT_NEAR(rig.output().goal_mm, place, 5 * 0.005 + 0.002) << "and one tick's travel to the middle";
    EXPECT_GE(rig.run_until_stereo(), 0) << place;
  }
}

TEST(mask_control, lost_eyes_cancel_an_announced_move_back) {
  MaskRig rig(little_travel(0.5));
  rig.head = walk_right(4.0, 100);
  ASSERT_GE(rig.run_until_stereo(), 0);
  while (rig.state().mono_from_ns == 0) rig.tick();
  rig.eyes = false;
  rig.tick();
  ASSERT_EQ(rig.state().phase, MaskPhase::frozen);
  EXPECT_EQ(rig.state().mono_from_ns, 0);
  EXPECT_EQ(rig.state().mono_until_ns, 0);
}

TEST(mask_control, publishes_the_goals_velocity) {
  MaskRigSettings settings;
  settings.servo.simulated.start_mm = -1.2;
  MaskRig rig(settings);
  rig.head = [](double) { return Eigen::Vector3d(30, 0, 650); };
  MaskControl::Output before;
  std::array<int, 2> moves{};
  rig.each_tick = [&](const auto&, const MaskControl::Output& out) {
    const double velocity = (out.goal_mm - before.goal_mm) / 0.005;
    if (before.powered && out.powered && out.state.phase == before.state.phase && std::abs(velocity) > 4.999) {
      const bool following = out.state.phase == MaskPhase::following;
      // A goal that catches up with a resting head will come to rest.
      EXPECT_NEAR(out.state.goal_velocity_mm_s, following ? 0 : velocity, 1e-6) << static_cast<int>(out.state.phase);
      ++moves[following ? 1 : 0];
    }
    before = out;
  };
  ASSERT_GE(rig.run_until_stereo(), 0);
  rig.eyes = false;
  ASSERT_GE(rig.run_until(MaskPhase::parked), 0);
  rig.eyes = true;
  ASSERT_GE(rig.run_until_stereo(), 0);
  rig.hold_mm = -1;
  rig.run_for(800 * kMs);
  EXPECT_GT(moves[0], 80) << "homing, parking and holding";
  EXPECT_GE(moves[1], 6);
}

TEST(mask_control, follows_again_when_the_eyes_return_soon) {
  MaskRig rig;
  rig.head = oscillating(100, 6);
  ASSERT_GE(rig.run_until_stereo(), 0);
  rig.eyes = false;
  ASSERT_GE(rig.run_until(MaskPhase::frozen), 0);
  rig.run_for(100 * kMs);
  rig.eyes = true;
  rig.tick();
  EXPECT_EQ(rig.state().phase, MaskPhase::following);
  EXPECT_FALSE(rig.state().stereo_allowed) << "not before the mask has caught up";
  EXPECT_THAT(rig.run_until_stereo(), testing::AllOf(testing::Ge(0), testing::Lt(150)));
}

TEST(mask_control, waits_for_a_mono_picture_when_the_eyes_return_elsewhere) {
  MaskRig rig(little_travel(0.4));
  double x = 0;
  rig.head = [&](double) { return Eigen::Vector3d(x, 0, 650); };
  ASSERT_GE(rig.run_until_stereo(), 0);
  rig.eyes = false;
  ASSERT_GE(rig.run_until(MaskPhase::frozen), 0);
  rig.run_for(120 * kMs);
  x = 150;
  rig.eyes = true;
  rig.run_for(50 * kMs);
  EXPECT_EQ(rig.state().phase, MaskPhase::frozen);
  rig.picture_mono = true;
  EXPECT_THAT(rig.run_until(MaskPhase::following), testing::AllOf(testing::Ge(0), testing::Le(10)));
  EXPECT_GE(rig.run_until_stereo(500), 0);
}

TEST(mask_control, an_unplugged_motor_is_absent_at_once_and_homes_when_it_is_back) {
  MaskRig rig;
  ASSERT_GE(rig.run_until_stereo(), 0);
  rig.servo().line().unplug();
  EXPECT_THAT(rig.run_until(MaskPhase::absent), testing::AllOf(testing::Ge(0), testing::Le(10)));
  EXPECT_FALSE(rig.output().powered);
  EXPECT_FALSE(rig.state().stereo_allowed);
  rig.run_for(100 * kMs);
  rig.servo().plug();
  EXPECT_GE(rig.run_until(MaskPhase::homing, 1'000), 0);
  const std::int64_t ms = rig.run_until_stereo();
  EXPECT_GE(ms, 0);
  EXPECT_LT(ms, 1'000);
}

/// The last input of the mask control, to be repeated with a change.
class LastInput {
 public:
  explicit LastInput(MaskRig& rig) : rig_(rig) {
    rig.each_tick = [this](const MaskControl::Input& given, const auto&) { input = given; };
  }
  MaskControl::Output step() {
    input.now_ns += kTickNs;
    return rig_.control().step(input);
  }
  MaskControl::Input input;

 private:
  MaskRig& rig_;
};

TEST(mask_control, the_motor_is_absent_when_its_port_is_gone) {
  MaskRig rig;
  LastInput last(rig);
  ASSERT_GE(rig.run_until_stereo(), 0);
  EXPECT_TRUE(last.step().state.stereo_allowed);
  last.input.servo.status = port::PortStatus::gone;
  const MaskControl::Output out = last.step();
  EXPECT_EQ(out.state.phase, MaskPhase::absent);
  EXPECT_FALSE(out.powered);
}

TEST(mask_control, a_silent_motor_is_absent_when_its_last_reading_is_old) {
  MaskRig rig;
  ASSERT_GE(rig.run_until_stereo(), 0);
  rig.mask().mute(true);
  const std::int64_t ms = rig.run_until(MaskPhase::absent);
  EXPECT_GE(ms, 50);
  EXPECT_LE(ms, 110);
}

TEST(mask_control, recovers_from_a_tripped_watchdog) {
  MaskRig rig;
  ASSERT_GE(rig.run_until_stereo(), 0);
  rig.servo().stall(500 * kMs);
  EXPECT_TRUE(rig.mask().watchdog_tripped());
  rig.tick();
  EXPECT_FALSE(rig.state().stereo_allowed);
  const std::int64_t ms = rig.run_until_stereo();
  EXPECT_GE(ms, 0);
  EXPECT_LT(ms, 1'000);
}

// --- faults ---

TEST(mask_control, detects_and_reports_a_jammed_mask_and_switches_torque_off) {
  MaskRig rig;
  rig.head = walk_right(5.0, 100);
  ASSERT_GE(rig.run_until_stereo(), 0);
  rig.mask().jam(true);
  while (rig.seconds() < 5.0) rig.tick();
  // At 0.44 mm/s the mask is 0.05 mm behind after 110 ms, and outside of a slow motor's envelope a little later.
  const std::int64_t ms = rig.run_until(MaskPhase::stuck);
  EXPECT_GE(ms, 300);
  EXPECT_LE(ms, 300 + 113 + 90);
  EXPECT_FALSE(rig.output().powered);
  EXPECT_FALSE(rig.state().stereo_allowed);
  rig.run_for(50 * kMs);
  EXPECT_FALSE(rig.mask().torque());
  rig.mask().jam(false);
  rig.run_for(2'000 * kMs);
  EXPECT_EQ(rig.state().phase, MaskPhase::stuck) << "latched";
  rig.rearm = true;
  rig.tick();
  EXPECT_EQ(rig.state().phase, MaskPhase::homing);
  EXPECT_GE(rig.run_until_stereo(), 0);
}

TEST(mask_control, the_first_fault_stays_latched) {
  MaskRig rig;
  LastInput last(rig);
  rig.mask().jam(true);
  ASSERT_GE(rig.run_until(MaskPhase::stuck, 3'000), 0);
  last.input.servo.phase = ServoPhase::alarm;
  EXPECT_EQ(last.step().state.phase, MaskPhase::stuck) << "the alarm is of the jam";
}

TEST(mask_control, waits_three_seconds_for_a_rearmed_motor) {
  MaskRig rig;
  LastInput last(rig);
  ASSERT_GE(rig.run_until_stereo(), 0);
  last.input.servo.phase = ServoPhase::alarm;
  ASSERT_EQ(last.step().state.phase, MaskPhase::alarm);
  last.input.rearm = true;
  ASSERT_TRUE(last.step().powered) << "what the motor starts anew for";
  last.input.rearm = false;
  last.input.servo = {};
  const std::int64_t rearmed = last.input.now_ns;
  while (last.input.now_ns < rearmed + 2'990 * kMs) {
    const MaskControl::Output out = last.step();
    ASSERT_EQ(out.state.phase, MaskPhase::homing);
    ASSERT_FALSE(out.powered);
  }
  for (int i = 0; i < 4; ++i) last.step();
  EXPECT_EQ(last.step().state.phase, MaskPhase::absent);
}

TEST(mask_control, detects_a_mask_jammed_during_a_move_back) {
  MaskRig rig(little_travel(0.5));
  rig.head = walk_right(4.0, 100);
  ASSERT_GE(rig.run_until_stereo(), 0);
  ASSERT_GE(rig.run_until(MaskPhase::flying_back), 0);
  rig.mask().jam(true);
  rig.each_tick = [](const auto&, const MaskControl::Output& out) { EXPECT_FALSE(out.state.stereo_allowed); };
  EXPECT_THAT(rig.run_until(MaskPhase::stuck), testing::AllOf(testing::Ge(0), testing::Le(500)));
  EXPECT_GE(rig.state().half_periods, 0);
}

TEST(mask_control, detects_a_mask_jammed_before_homing) {
  MaskRig rig;
  rig.mask().jam(true);
  EXPECT_GE(rig.run_until(MaskPhase::stuck, 3'000), 0);
}

TEST(mask_control, fast_and_slow_motors_are_not_taken_for_stuck) {
  for (const double lag_ms : {2.0, 15.0, 40.0}) {
    for (const double speed : {4.0, 6.0, 20.0}) {
      MaskRigSettings settings = little_travel(0.5);
      settings.servo.simulated.lag_ms = lag_ms;
      settings.servo.simulated.speed_mm_s = speed;
      MaskRig rig(settings);
      const HeadMotion motion(MotionKind::turn, 5, {0, 0, 650}, 1.2);
      rig.head = [&](double seconds) { return motion.between_eyes_mm(seconds); };
      bool stuck = false;
      rig.each_tick = [&](const auto&, const MaskControl::Output& out) { stuck = stuck || out.state.phase == MaskPhase::stuck; };
      rig.run_for(30'000 * kMs);
      EXPECT_FALSE(stuck) << lag_ms << " ms, " << speed << " mm/s";
    }
  }
}

TEST(mask_control, the_motors_alarm_is_latched_until_it_is_rearmed) {
  MaskRig rig;
  ASSERT_GE(rig.run_until_stereo(), 0);
  rig.mask().raise_hardware_error(1U << 2U);
  EXPECT_THAT(rig.run_until(MaskPhase::alarm), testing::AllOf(testing::Ge(0), testing::Le(50)));
  EXPECT_FALSE(rig.output().powered);
  rig.run_for(3'000 * kMs);
  EXPECT_EQ(rig.state().phase, MaskPhase::alarm);
  rig.rearm = true;
  rig.tick();
  EXPECT_EQ(rig.state().phase, MaskPhase::homing);
  const std::int64_t ms = rig.run_until_stereo();
  EXPECT_GE(ms, 0);
  EXPECT_LT(ms, 3'000);
}

TEST(mask_control, a_lasting_fault_returns_after_rearming) {
  MaskRig rig;
  ASSERT_GE(rig.run_until_stereo(), 0);
  rig.mask().raise_hardware_error(1U << 0U);
  ASSERT_GE(rig.run_until(MaskPhase::alarm), 0);
  rig.rearm = true;
  rig.each_tick = [&](const auto&, const auto&) { rig.mask().raise_hardware_error(1U << 0U); };
  rig.tick();
  EXPECT_NE(rig.state().phase, MaskPhase::alarm);
  const std::int64_t ms = rig.run_until(MaskPhase::alarm);
  EXPECT_GE(ms, 0);
  EXPECT_LE(ms, 4'000);
  rig.run_for(5'000 * kMs);
  EXPECT_EQ(rig.state().phase, MaskPhase::alarm);
}

// --- calibration ---

TEST(mask_control, holds_the_position_that_calibration_requests) {
  MaskRig rig;
  rig.head = oscillating(100, 4);
  ASSERT_GE(rig.run_until_stereo(), 0);
  ConditionChecks conditions(rig, {});
  rig.each_tick = [&](const auto& in, const auto& out) { conditions.check(in, out); };
  for (const double place : {0.3, -1.2, 99.0}) {
    rig.hold_mm = place;
    rig.tick();
    EXPECT_EQ(rig.state().phase, MaskPhase::held);
    rig.run_for(1'500 * kMs);
    EXPECT_TRUE(rig.state().stereo_allowed);
    EXPECT_NEAR(rig.mask().motor_mm(), std::min(place, 2.0), 0.002);
  }
  rig.hold_mm = std::numeric_limits<double>::quiet_NaN();
  rig.run_for(200 * kMs);
  EXPECT_NEAR(rig.mask().motor_mm(), 2.0, 0.002);
  rig.hold_mm.reset();
  rig.tick();
  EXPECT_EQ(rig.state().phase, MaskPhase::following);
  EXPECT_GE(rig.run_until_stereo(), 0);
}

TEST(mask_control, stereo_waits_until_the_mask_is_at_the_held_position) {
  MaskRig rig;
  ASSERT_GE(rig.run_until_stereo(), 0);
  rig.hold_mm = -1.5;
  rig.each_tick = [&](const auto&, const MaskControl::Output& out) {
    if (!out.state.stereo_allowed) return;
    EXPECT_NEAR(rig.mask().motor_mm(), -1.5, MaskLimits{}.settle_mm);
  };
  rig.tick();
  EXPECT_EQ(rig.state().phase, MaskPhase::held);
  EXPECT_THAT(rig.run_until_stereo(), testing::AllOf(testing::Ge(300), testing::Lt(600))) << "1.5 mm at 5 mm/s";
}

TEST(mask_control, freezes_after_a_hold_without_eyes) {
  MaskRig rig;
  ASSERT_GE(rig.run_until_stereo(), 0);
  rig.hold_mm = 0.7;
  rig.run_for(500 * kMs);
  rig.eyes = false;
  rig.run_for(500 * kMs);
  EXPECT_EQ(rig.state().phase, MaskPhase::held);
  rig.hold_mm.reset();
  rig.tick();
  EXPECT_EQ(rig.state().phase, MaskPhase::frozen);
  rig.run_for(100 * kMs);
  EXPECT_NEAR(rig.mask().motor_mm(), 0.7, 0.01);
}

TEST(mask_control, moves_to_new_optics_in_mono) {
  MaskRig rig;
  rig.head = [](double) { return Eigen::Vector3d(100, 0, 650); };
  ASSERT_GE(rig.run_until_stereo(), 0);
  display::MaskOptics optics;
  optics.zero_mm = 0.1;
  rig.control().set_optics(optics);
  rig.tick();
  EXPECT_FALSE(rig.state().stereo_allowed);
  EXPECT_GE(rig.run_until_stereo(), 0);
  EXPECT_NEAR(rig.output().goal_mm, display::mask_position_mm(optics, {100, 0, 650}) - rig.state().half_periods * rig.half_period_mm(),
              1e-6);
}

// --- invalid input ---

TEST(mask_control, invalid_input_never_gives_invalid_output) {
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  const std::vector<double> numbers = {0, 1, -1, 650, -650, 1e-300, 1e9, -1e9, 1e300, nan, inf, -inf};
  std::mt19937 random(4);
  const auto any = [&] { return numbers[random() % numbers.size()]; };
  for (int run = 0; run < 40; ++run) {
    MaskLimits limits;
    limits.travel_mm = 0.5;
    MaskControl control(display::MaskOptics{}, limits);
    MaskControl::Input input;
    input.now_ns = 1'000'000'000;
    double goal = 0;
    bool powered = false;
    for (int i = 0; i < 5'000; ++i) {
      const std::int64_t step = random() % 50 == 0 ? static_cast<std::int64_t>(random() % 2'000) * kMs - 500 * kMs : kTickNs;
      input.now_ns += step;
      const bool sane = random() % 4 != 0;
      input.head.time_ns = random() % 10 == 0 ? static_cast<std::int64_t>(any() > 0 ? 1 : 0) : input.now_ns - 20 * kMs;
      input.head.between_eyes_mm = sane ? Eigen::Vector3d(std::sin(i * 0.01) * 200, 0, 650) : Eigen::Vector3d(any(), any(), any());
      input.head.velocity_mm_s = sane ? Eigen::Vector3d::Zero() : Eigen::Vector3d(any(), any(), any());
      input.head_seen = random() % 20 != 0;
      input.servo.phase = random() % 100 == 0 ? static_cast<ServoPhase>(random() % 4) : ServoPhase::ready;
      input.servo.fresh = random() % 5 != 0;
      input.servo.reading = {input.now_ns - 5 * kMs, random() % 10 == 0 ? any() : goal, random() % 10 == 0 ? any() : 0.0};
      input.servo_lag_ns = random() % 10 == 0 ? static_cast<std::int64_t>(random()) * 1'000'000 - 500'000'000'000 : 15 * kMs;
      input.picture_mono = random() % 2 == 0;
      const double hold = any();
      input.hold_mm = random() % 30 == 0 ? &hold : nullptr;
      input.rearm = random() % 50 == 0;
      const MaskControl::Output out = control.step(input);
      ASSERT_TRUE(std::isfinite(out.goal_mm));
      ASSERT_LE(std::abs(out.goal_mm), limits.travel_mm);
      if (powered && out.powered && !input.rearm) {
        ASSERT_LE(std::abs(out.goal_mm - goal), 5.0 * 0.02 + 1e-9);
      }
      ASSERT_TRUE(std::isfinite(out.state.position_mm) && std::isfinite(out.state.velocity_mm_s) &&
                  std::isfinite(out.state.goal_velocity_mm_s));
      ASSERT_TRUE(std::isfinite(mask_position_at(out.state, input.now_ns + 20 * kMs)));
      if (out.state.stereo_allowed) {
        ASSERT_TRUE(out.powered);
      }
      goal = out.goal_mm;
      powered = out.powered;
    }
  }
}

}  // namespace
}  // namespace prismesh::drivers::prism_servo

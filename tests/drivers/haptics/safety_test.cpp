// Each rule of the safety by itself, in virtual time.
#include "drivers/haptics/safety.h"

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/haptics/stiffness.h"

namespace prismesh::drivers::haptics {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A pen and a loop at 1 kHz. Tests change what the next tick sees.
struct SafetyRig {
  SafetyRig() : SafetyRig(HapticLimits{}) {}
  explicit SafetyRig(const HapticLimits& limits, const SafetyRecord& stored = {}) : safety(limits, Eigen::Vector3d::Constant(10), stored) {
    input.now_ns = 5'000 * kMs;
    input.ready = true;
  }

  SafetyOutput tick(std::int64_t after_ns = kMs) {
    input.now_ns += after_ns;
    if (poses) input.measured_ns = input.now_ns;
    input.parts = parts;
    const SafetyOutput output = safety.step(input);
    input.rearm = false;
    input.io_error = false;
    input.lost_replies = 0;
    return output;
  }
  /// Arms with a free pen and waits until the force may be full.
  void arm(int wait_ms = 1100) {
    const std::vector<ForcePart> wanted = std::exchange(parts, {});
    tick();
    input.rearm = true;
    EXPECT_EQ(tick().record.phase, SafetyPhase::armed);
    for (int i = 0; i < wait_ms; ++i) tick();
    parts = wanted;
  }
  SafetyOutput run(int ticks) {
    SafetyOutput output;
    for (int i = 0; i < ticks; ++i) output = tick();
    return output;
  }
  void want(double x, double y = 0, double z = 0) { parts = {{Eigen::Vector3d(x, y, z), 0, false}}; }

  Safety safety;
  SafetyInput input;
  bool poses = true;
  std::vector<ForcePart> parts;
};

void expect_latched(SafetyRig& rig, const SafetyOutput& output, SafetyFault fault) {
  EXPECT_EQ(output.record.phase, SafetyPhase::latched);
  EXPECT_EQ(output.record.fault, fault);
  EXPECT_TRUE(output.record_changed);
  EXPECT_EQ(output.newton.norm(), 0);
  // It stays, whatever comes, until the user arms again.
  rig.poses = true;
  for (ForcePart& part : rig.parts)
    if (!part.newton.allFinite()) part.newton = Eigen::Vector3d::UnitX();
  if (!rig.input.position_mm.allFinite()) rig.input.position_mm.setZero();
  for (int i = 0; i < 2000; ++i) ASSERT_EQ(rig.tick().newton.norm(), 0);
  EXPECT_EQ(rig.safety.record().phase, SafetyPhase::latched);
  rig.parts.clear();
  rig.input.rearm = true;
  EXPECT_EQ(rig.tick().record.phase, SafetyPhase::armed);
}

TEST(safety, starts_disarmed_and_gives_no_force) {
  SafetyRig rig;
  rig.want(1);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(rig.tick().newton.norm(), 0);
  EXPECT_EQ(rig.safety.record().phase, SafetyPhase::disarmed);
}

TEST(safety, a_button_that_is_held_at_the_start_does_not_arm) {
  SafetyRig rig;
  for (int i = 0; i < 100; ++i) {
    rig.input.rearm = true;
    EXPECT_EQ(rig.tick().record.phase, SafetyPhase::disarmed);
  }
  rig.tick();
  rig.input.rearm = true;
  EXPECT_EQ(rig.tick().record.phase, SafetyPhase::armed);
}

TEST(safety, refuses_to_arm_in_contact_or_with_a_device_that_is_not_ready) {
  SafetyRig rig;
  rig.want(0.6);
  rig.tick();
  rig.input.rearm = true;
  SafetyOutput output = rig.tick();
  EXPECT_TRUE(output.rearm_refused);
  EXPECT_EQ(output.record.phase, SafetyPhase::disarmed);
  rig.parts.clear();
  rig.input.ready = false;
  rig.tick();
  rig.input.rearm = true;
  output = rig.tick();
  EXPECT_TRUE(output.rearm_refused);
  EXPECT_EQ(output.record.phase, SafetyPhase::disarmed);
}

TEST(safety, force_begins_below_half_a_newton_and_rises_over_a_second) {
  SafetyRig rig;
  rig.arm(0);
  rig.want(20);
  const std::int64_t armed_ns = rig.safety.record().since_ns;
  double last = 0;
  for (int i = 0; i < 1000; ++i) {
    const SafetyOutput output = rig.tick();
    const double seconds = static_cast<double>(rig.input.now_ns - armed_ns) * 1e-9;
    EXPECT_LE(output.newton.norm(), 0.4 + 7.6 * seconds + 1e-12);
    EXPECT_GE(output.newton.norm(), last - 1e-12);
    last = output.newton.norm();
    if (i == 5) {
      EXPECT_LT(last, 0.5);
      EXPECT_GT(last, 0.4);
    }
  }
  EXPECT_NEAR(rig.run(50).newton.x(), std::min(8.0, 0.020 / 5.5e-3), 1e-9) << "the tank limits what the hand hasn't paid for";
}

TEST(safety, sums_all_parts_before_it_limits) {
  SafetyRig rig;
  rig.arm();
  rig.parts = {{{3, 0, 0}, 0, false}, {{-1, 0.5, 0}, rig.input.now_ns, false}, {{-1, 0, 0.25}, 0, true}};
  const SafetyOutput output = rig.run(50);
  EXPECT_NEAR((output.newton - Eigen::Vector3d(1, 0.5, 0.25)).norm(), 0, 1e-12);
}

TEST(safety, limits_rises_in_any_direction_and_lets_falls_through) {
  SafetyRig rig;
  rig.arm();
  rig.want(2);
  double last = 0;
  for (int i = 0; i < 10; ++i) {
    const double now = rig.tick().newton.x();
    EXPECT_NEAR(now - last, 0.2, 1e-12);
    last = now;
  }
  rig.want(0.3);
  EXPECT_NEAR(rig.tick().newton.x(), 0.3, 1e-12) << "a fall is free";
  rig.want(2);
  rig.run(20);
  rig.want(-2);
  EXPECT_NEAR(rig.tick().newton.x(), -0.2, 1e-12) << "the opposite direction is a rise from zero";
  rig.want(0, 2);
  EXPECT_NEAR(rig.tick().newton.y(), 0.2, 1e-12) << "so is another direction";
}

TEST(safety, a_long_tick_gives_no_larger_rise) {
  SafetyRig rig;
  rig.arm();
  rig.want(2);
  EXPECT_NEAR(rig.tick(3 * kMs).newton.x(), 0.4, 1e-12);
}

/// Lets the hand press, so that it has paid for forces.
void press(SafetyRig& rig, const Eigen::Vector3d& newton) {
  for (int i = 0; i < 200; ++i) {
    rig.input.position_mm -= newton.normalized() * 0.1;
    rig.parts = {{newton, 0, false}};
    rig.tick();
  }
}

TEST(safety, clamps_the_length_of_the_vector_and_keeps_its_direction) {
  SafetyRig rig;
  rig.arm();
  press(rig, {20, 4, 0});
  const SafetyOutput output = rig.tick();
  EXPECT_NEAR(output.newton.norm(), 8, 1e-9);
  EXPECT_NEAR(output.newton.y() / output.newton.x(), 0.2, 1e-9);
}

TEST(safety, keeps_to_each_motor_and_keeps_the_direction) {
  HapticLimits limits;
  SafetyRig rig(limits);
  rig.safety = Safety(limits, {3, 10, 10});
  rig.arm();
  press(rig, {6, 2, 0});
  const SafetyOutput output = rig.tick();
  EXPECT_NEAR(output.newton.x(), 3, 1e-9);
  EXPECT_NEAR(output.newton.y(), 1, 1e-9);
}

TEST(safety, old_data_fades_to_zero_and_what_has_no_age_stays) {
  SafetyRig rig;
  rig.arm();
  const std::int64_t read_ns = rig.input.now_ns;
  rig.parts = {{{2, 0, 0}, read_ns, false}, {{0, 0.5, 0}, 0, false}};
  SafetyOutput output;
  while (rig.input.now_ns < read_ns + 100 * kMs) output = rig.tick();
  EXPECT_NEAR(output.newton.x(), 2, 1e-12);
  while (rig.input.now_ns < read_ns + 125 * kMs) output = rig.tick();
  EXPECT_NEAR(output.newton.x(), 1, 1e-12);
  while (rig.input.now_ns < read_ns + 150 * kMs) output = rig.tick();
  EXPECT_EQ(output.newton.x(), 0);
  EXPECT_NEAR(output.newton.y(), 0.5, 1e-12);
  rig.parts[0].from_ns = rig.input.now_ns + 3 * kMs;
  EXPECT_EQ(rig.tick().newton.x(), 0) << "data from the future is no data";
}

TEST(safety, a_late_tick_gives_damping_only) {
  SafetyRig rig;
  rig.arm();
  rig.parts = {{{2, 0, 0}, 0, false}, {{0, 0.3, 0}, 0, true}};
  rig.run(50);
  EXPECT_FALSE(rig.tick(3 * kMs).damping_only);
  const SafetyOutput output = rig.tick(3 * kMs + 1);
  EXPECT_TRUE(output.damping_only);
  EXPECT_EQ(output.newton.x(), 0);
  EXPECT_NEAR(output.newton.y(), 0.3, 1e-12);
  EXPECT_EQ(output.record.phase, SafetyPhase::armed);
  EXPECT_NEAR(rig.tick().newton.x(), 0.2, 0.01) << "and rises again";
}

TEST(safety, a_force_whose_command_has_ended_rises_from_zero) {
  SafetyRig rig;
  rig.arm();
  rig.parts = {{{2, 0, 0}, 0, true}};
  EXPECT_NEAR(rig.run(50).newton.x(), 2, 1e-12);
  EXPECT_NEAR(rig.tick(3 * kMs + 1).newton.x(), 0.4, 1e-12);
}

TEST(safety, a_command_holds_no_longer_than_a_late_tick) {
  SafetyRig rig;
  rig.arm();
  const SafetyOutput output = rig.tick();
  EXPECT_EQ(output.valid_until_ns, rig.input.now_ns + 3 * kMs);
}

TEST(safety, a_tick_that_is_too_late_latches) {
  SafetyRig rig;
  rig.arm();
  rig.want(2);
  rig.run(50);
  EXPECT_EQ(rig.tick(11 * kMs).record.phase, SafetyPhase::armed);
  expect_latched(rig, rig.tick(11 * kMs + 1), SafetyFault::late_tick);
}

TEST(safety, numbers_that_are_none_latch) {
  for (const double bad : {kNaN, std::numeric_limits<double>::infinity(), 1e300}) {
    for (int axis = 0; axis < 3; ++axis) {
      SafetyRig force;
      force.arm();
      force.want(1);
      force.run(20);
      force.parts[0].newton[axis] = bad;
      expect_latched(force, force.tick(), SafetyFault::not_finite);
      SafetyRig pose;
      pose.arm();
      pose.want(1);
      pose.run(20);
      pose.input.position_mm[axis] = bad;
      const SafetyOutput output = pose.tick();
      pose.input.position_mm[axis] = 0;
      expect_latched(pose, output, SafetyFault::not_finite);
    }
  }
}

TEST(safety, a_jump_of_the_pose_latches) {
  SafetyRig rig;
  rig.arm();
  rig.want(1);
  rig.run(20);
  rig.input.position_mm.x() += 2.45;
  EXPECT_EQ(rig.tick().record.phase, SafetyPhase::armed);
  rig.run(20);
  rig.input.position_mm.y() += 2.55;
  expect_latched(rig, rig.tick(), SafetyFault::jump);
}

TEST(safety, more_than_the_max_speed_latches) {
  for (const double speed : {1.49, 1.51}) {
    SafetyRig rig;
    rig.arm();
    rig.want(1);
    rig.run(20);
    SafetyOutput output;
    for (int i = 0; i < 6 && output.record.phase != SafetyPhase::latched; ++i) {
      rig.input.position_mm.z() += speed;
      output = rig.tick();
    }
    if (speed > 1.5) {
      expect_latched(rig, output, SafetyFault::too_fast);
    } else {
      EXPECT_EQ(output.record.phase, SafetyPhase::armed);
    }
  }
}

TEST(safety, an_error_of_the_line_and_a_lost_reply_latch) {
  SafetyRig line;
  line.arm();
  line.want(1);
  line.run(20);
  line.input.io_error = true;
  expect_latched(line, line.tick(), SafetyFault::io_error);
  SafetyRig reply;
  reply.arm();
  reply.want(1);
  reply.run(20);
  reply.input.lost_replies = 1;
  expect_latched(reply, reply.tick(), SafetyFault::lost_reply);
}

TEST(safety, without_new_poses_damping_only_and_then_a_latch) {
  SafetyRig rig;
  rig.arm();
  rig.want(1);
  rig.run(20);
  rig.poses = false;
  for (int i = 1; i <= 10; ++i) {
    const SafetyOutput output = rig.tick();
    EXPECT_EQ(output.damping_only, i > 4);
    EXPECT_EQ(output.record.phase, SafetyPhase::armed);
    EXPECT_EQ(output.newton.norm() > 0, i <= 4);
  }
  expect_latched(rig, rig.tick(), SafetyFault::no_pose);
}

TEST(safety, merged_replies_are_no_fault) {
  SafetyRig rig;
  rig.arm();
  rig.want(0.5);
  for (int i = 0; i < 200; ++i) {
    // Every other tick has no reply; the next one has two, of which the newest counts.
    rig.poses = i % 2 == 1;
    if (rig.poses) rig.input.position_mm.x() += i < 100 ? 2 : -2;
    ASSERT_EQ(rig.tick().record.phase, SafetyPhase::armed);
  }
}

TEST(safety, poses_from_the_past_or_the_future_latch) {
  SafetyRig past;
  past.arm();
  past.poses = false;
  past.input.measured_ns -= 1;
  expect_latched(past, past.tick(), SafetyFault::pose_time);
  SafetyRig future;
  future.arm();
  future.poses = false;
  future.input.measured_ns = future.input.now_ns + kMs + 1;
  const SafetyOutput output = future.tick();
  EXPECT_EQ(output.record.fault, SafetyFault::pose_time);
}

TEST(safety, a_clock_that_goes_back_latches) {
  SafetyRig rig;
  rig.arm();
  rig.want(1);
  rig.poses = false;
  const SafetyOutput output = rig.tick(-1);
  EXPECT_EQ(output.record.fault, SafetyFault::clock);
  EXPECT_EQ(output.newton.norm(), 0);
}

TEST(safety, a_device_that_is_no_longer_ready_is_disarmed) {
  SafetyRig rig;
  rig.arm();
  rig.want(1);
  rig.run(20);
  rig.input.ready = false;
  EXPECT_EQ(rig.tick().record.phase, SafetyPhase::disarmed);
  rig.input.ready = true;
  EXPECT_EQ(rig.run(100).newton.norm(), 0);
}

TEST(safety, a_latch_and_a_crash_while_armed_outlive_the_program) {
  SafetyRig rig;
  rig.arm();
  const SafetyRecord armed = rig.safety.record();
  rig.input.io_error = true;
  const SafetyRecord latched = rig.tick().record;

  SafetyRig after_latch({}, latched);
  after_latch.want(1);
  EXPECT_EQ(after_latch.run(10).record, latched);
  SafetyRig after_crash({}, armed);
  after_crash.want(1);
  SafetyOutput output = after_crash.tick();
  EXPECT_TRUE(output.record_changed);
  EXPECT_EQ(output.record.phase, SafetyPhase::latched);
  EXPECT_EQ(output.record.fault, SafetyFault::died_armed);
  EXPECT_EQ(output.newton.norm(), 0);
  SafetyRig after_end({}, {SafetyPhase::disarmed, SafetyFault::none, 7});
  EXPECT_EQ(after_end.tick().record.phase, SafetyPhase::disarmed);
}

TEST(safety, puts_no_more_work_into_the_hand_than_twenty_millijoules_at_once_and_fifty_milliwatts) {
  SafetyRig rig;
  rig.arm();
  double joule = 0, seconds = 0;
  Eigen::Vector3d last = Eigen::Vector3d::Zero(), at = rig.input.position_mm;
  for (int i = 0; i < 20'000; ++i) {
    // The worst force: always along the motion.
    const double speed = 0.2 * std::cos(i * 0.01);
    rig.input.position_mm.x() += speed;
    rig.want(speed > 0 ? 5 : -5);
    const SafetyOutput output = rig.tick();
    joule += last.dot(rig.input.position_mm - at) * 1e-3;
    at = rig.input.position_mm;
    last = output.newton;
    seconds += 1e-3;
    ASSERT_LE(joule, 0.020 + 0.050 * seconds);
  }
  EXPECT_GT(joule, 0.5 * (0.050 * seconds)) << "most of what is allowed is given";
}

TEST(safety, gives_no_credit_for_a_way_on_which_the_command_has_ended) {
  SafetyRig rig;
  rig.arm();
  rig.want(1);
  const double before = rig.run(50).tank_joule;
  rig.input.position_mm.x() -= 2;
  EXPECT_NEAR(rig.tick().tank_joule, before + 0.002, 1e-9) << "2 mm against 1 N";
  rig.input.position_mm.x() -= 2;
  EXPECT_NEAR(rig.tick(5 * kMs).tank_joule, before + 0.002, 1e-9);
}

TEST(safety, counts_work_only_up_to_the_end_of_a_command) {
  SafetyRig rig;
  rig.arm();
  rig.want(1);
  const double before = rig.run(50).tank_joule;
  rig.input.position_mm.x() += 10;
  // 1 mm and 3 ms at 1.5 m/s, less what is refilled in 10 ms.
  EXPECT_NEAR(rig.tick(10 * kMs).tank_joule, before - 0.0055 + 0.0005, 1e-9);
}

TEST(safety, counts_the_worst_of_the_forces_since_the_last_pose) {
  SafetyRig rig;
  rig.arm();
  rig.want(1);
  const double before = rig.run(50).tank_joule;
  rig.poses = false;
  rig.tick();
  rig.want(0.1);
  rig.tick();
  rig.poses = true;
  rig.input.position_mm.x() += 3;
  EXPECT_NEAR(rig.tick().tank_joule, before - 0.003 + 0.00005, 1e-9) << "not 0.1 N";
}

TEST(safety, gives_back_what_a_spring_took) {
  SafetyRig rig;
  rig.arm();
  // Presses 10 mm into a spring of 600 N/m and back, ten times: nothing is cut off.
  for (int i = 0; i < 20'000; ++i) {
    const double depth_mm = 5 - 5 * std::cos(2 * 3.14159265358979 * i / 2000);
    rig.input.position_mm.x() = -depth_mm;
    rig.want(0.6 * depth_mm);
    const SafetyOutput output = rig.tick();
    EXPECT_FALSE(output.tank_limited) << i;
  }
}

TEST(stiffness, is_the_smallest_of_its_bounds) {
  haptic_pen::PenLimits device;
  device.damping_newton_s_m = 1.5;
  device.friction_newton = 0.05;
  device.quantum_mm = 0.01;
  device.delay_ns = 1'000'000;
  EXPECT_NEAR(max_stiffness_newton_m(device, 1'000'000), 1000, 1e-9) << "b / (T / 2 + delay)";
  device.quantum_mm = 0.2;
  EXPECT_NEAR(max_stiffness_newton_m(device, 1'000'000), 500, 1e-9) << "2 f / quantum";
  device.max_stiffness_newton_m = 300;
  EXPECT_EQ(max_stiffness_newton_m(device, 1'000'000), 300);
  device.damping_newton_s_m = 0;
  EXPECT_EQ(max_stiffness_newton_m(device, 1'000'000), 0);
  device.damping_newton_s_m = kNaN;
  EXPECT_EQ(max_stiffness_newton_m(device, 1'000'000), 0);
}

}  // namespace
}  // namespace prismesh::drivers::haptics

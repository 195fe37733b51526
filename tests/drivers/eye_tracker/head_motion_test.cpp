// The simulated head: smooth, repeatable, with exact velocity and the documented kinds of motion.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "drivers/eye_tracker/head_motion.h"

namespace prismesh::drivers::eye_tracker {
namespace {

using Eigen::Vector3d;

constexpr MotionKind kKinds[] = {MotionKind::still, MotionKind::sway, MotionKind::lean, MotionKind::turn, MotionKind::tour};

TEST(HeadMotion, velocity_is_the_derivative_of_the_position) {
  for (const MotionKind kind : kKinds)
    for (const double speed : {1.0, 0.4}) {
      const HeadMotion motion(kind, 5, {10, 20, 600}, speed);
      for (double t = -3; t < 90; t += 0.0137) {
        constexpr double kStep = 1e-5;
        const Vector3d measured = (motion.between_eyes_mm(t + kStep) - motion.between_eyes_mm(t - kStep)) / (2 * kStep);
        ASSERT_LT((measured - motion.velocity_mm_s(t)).norm(), 1e-2) << "kind " << static_cast<int>(kind) << " at " << t;
      }
    }
}

TEST(HeadMotion, is_repeatable_for_a_seed_and_differs_between_seeds) {
  for (const MotionKind kind : kKinds) {
    const HeadMotion one(kind, 7), same(kind, 7), other(kind, 8);
    EXPECT_EQ(one.between_eyes_mm(30.5), same.between_eyes_mm(30.5));
    EXPECT_EQ(one.between_eyes_mm(2.25), same.between_eyes_mm(2.25));  // independent of earlier calls
    EXPECT_GT((one.between_eyes_mm(2.25) - other.between_eyes_mm(2.25)).norm(), 1e-3);
  }
}

struct Measured {
  double peak_mm_s = 0;
  Vector3d reach_mm = Vector3d::Zero();
};
Measured measure(MotionKind kind, std::uint64_t seed) {
  Measured measured;
  const HeadMotion motion(kind, seed, {0, 0, 650});
  for (double t = 0; t < 60; t += 0.005) {
    measured.peak_mm_s = std::max(measured.peak_mm_s, motion.velocity_mm_s(t).norm());
    measured.reach_mm = measured.reach_mm.cwiseMax((motion.between_eyes_mm(t) - Vector3d(0, 0, 650)).cwiseAbs());
  }
  return measured;
}

TEST(HeadMotion, each_kind_has_its_documented_amplitude_and_speed) {
  double sum_of_peaks = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Measured still = measure(MotionKind::still, seed);
    EXPECT_LT(still.reach_mm.maxCoeff(), 1.5);
    EXPECT_LT(still.peak_mm_s, 15);
    const Measured sway = measure(MotionKind::sway, seed);
    EXPECT_GT(sway.reach_mm.x(), 15);
    EXPECT_LT(sway.reach_mm.x(), 60);
    EXPECT_LT(sway.peak_mm_s, 150);
    const Measured lean = measure(MotionKind::lean, seed);
    EXPECT_NEAR(lean.reach_mm.z(), 76, 3);
    EXPECT_LT(lean.peak_mm_s, 300);
    const Measured turn = measure(MotionKind::turn, seed);
    EXPECT_NEAR(turn.peak_mm_s, 412, 15);
    sum_of_peaks += turn.peak_mm_s;
    const Measured tour = measure(MotionKind::tour, seed);
    EXPECT_LT(tour.peak_mm_s, 440);
  }
  EXPECT_NEAR(sum_of_peaks / 20, 412, 5);
}

TEST(HeadMotion, unknown_kinds_are_refused_with_the_nearest_name) {
  EXPECT_EQ(motion_kind_from("lean").value(), MotionKind::lean);
  const auto refused = motion_kind_from("trun");
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("nearest is \"turn\""), std::string::npos) << refused.error().message;
}

}  // namespace
}  // namespace prismesh::drivers::eye_tracker

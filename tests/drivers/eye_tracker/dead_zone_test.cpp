// The dead zone: an idle picture doesn't change, a slow motion shows no steps, a fast one isn't delayed.
#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "drivers/eye_tracker/filter.h"
#include "drivers/eye_tracker/head_motion.h"
#include "tests/support/head_trials.h"

namespace prismesh::drivers::eye_tracker {
namespace {

using Eigen::Vector3d;

/// Pictures at 60 Hz: a tracker with 1 mm of noise, the filter, a prediction of 60 ms, and the dead zone.
struct Drawn {
  int changed = 0;  ///< number of pictures that differ from the previous one
  int pictures = 0;
  Vector3d max_step_mm = Vector3d::Zero();
  Vector3d max_error_mm = Vector3d::Zero();
  double square_sum = 0;  ///< of the steps in x
  double rms_step_mm() const { return std::sqrt(square_sum / pictures); }
};
template <class TruePlace>
Drawn draw(TruePlace&& true_place, std::uint64_t seed, const Vector3d& radius_mm, double seconds) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0, 1);
  HeadFilter filter(HeadFilter::Options{});
  DeadZone zone(radius_mm);
  Drawn drawn;
  Vector3d last = Vector3d::Zero();
  for (int i = 0; i < static_cast<int>(seconds * 60); ++i) {
    const double t = i / 60.0;
    HeadSample sample;
    sample.measured_ns = 1'000'000'000 + static_cast<std::int64_t>(t * 1e9);
    sample.between_eyes_mm = true_place(t);
    for (int axis = 2; axis >= 0; --axis)
      sample.between_eyes_mm[axis] += normal(random);  // one statement each, because the order of evaluation of arguments isn't defined
    filter.take(sample);
    const Vector3d place = zone.follow(predict(filter.state(), sample.measured_ns + 60'000'000));
    if (t > 2) {
      ++drawn.pictures;
      drawn.changed += place != last;
      drawn.square_sum += (place - last).x() * (place - last).x();
      drawn.max_step_mm = drawn.max_step_mm.cwiseMax((place - last).cwiseAbs());
      drawn.max_error_mm = drawn.max_error_mm.cwiseMax((place - true_place(t + 0.06)).cwiseAbs());
    }
    last = place;
  }
  return drawn;
}

double changes_a_minute(const Vector3d& radius_mm) {
  std::vector<double> changes;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const HeadMotion motion(MotionKind::still, seed);
    const Drawn drawn = draw([&](double t) { return motion.between_eyes_mm(t); }, seed, radius_mm, 62);
    changes.push_back(3600.0 * drawn.changed / drawn.pictures);
  }
  return trials::quantile(changes, 0.5);
}

TEST(DeadZone, keeps_an_idle_picture_unchanged) {
  const double with = changes_a_minute(kRestingRadiusMm), without = changes_a_minute(Vector3d::Zero());
  std::printf("a resting head, 1 mm of noise: %.0f of 3600 pictures a minute change, %.0f without the zone\n", with, without);
  EXPECT_GT(without, 3590);
  EXPECT_LE(with, 36);  // one in a hundred
}

TEST(DeadZone, holds_inside_and_has_no_jump_at_the_edge) {
  DeadZone zone({2, 2, 2});
  EXPECT_EQ(zone.follow({5, 6, 7}), Vector3d(5, 6, 7));
  EXPECT_EQ(zone.follow({7, 4, 8.9}), Vector3d(5, 6, 7));
  EXPECT_EQ(zone.follow({3, 8, 5.1}), Vector3d(5, 6, 7));
  // Just beyond the edge the held position moves only slightly, and only in that axis.
  const Vector3d nudged = zone.follow({7.01, 6, 7});
  EXPECT_NEAR(nudged.x(), 5.02, 1e-3);
  EXPECT_EQ(nudged.y(), 6);
  EXPECT_EQ(nudged.z(), 7);
  // Far beyond the edge the held position is close to the given one, and never beyond it.
  EXPECT_NEAR(zone.follow({30, 6, 7}).x(), 30, 1e-3);
  EXPECT_LE(zone.follow({60, 6, 7}).x(), 60);
  EXPECT_GE(zone.follow({0, 6, 7}).x(), 0);
  zone.reset();
  EXPECT_EQ(zone.follow({1, 1, 1}), Vector3d(1, 1, 1));
  DeadZone none(Vector3d::Zero());
  none.follow({0, 0, 0});
  EXPECT_EQ(none.follow({0.001, -0.001, 3}), Vector3d(0.001, -0.001, 3));
}

TEST(DeadZone, a_slow_motion_shows_no_steps) {
  for (const double speed : {2.0, 5.0, 10.0, 20.0, 40.0}) {
    const auto move = [&](double t) { return Vector3d(speed * (t - 10), 0, 650); };
    const Drawn with = draw(move, 3, kRestingRadiusMm, 20), without = draw(move, 3, Vector3d::Zero(), 20);
    std::printf(
        "at %2.0f mm/s a picture's step is %.2f mm rms, %.2f mm at most (%.2f and %.2f mm without the zone), the error %.2f mm at most "
        "(%.2f mm)\n",
        speed, with.rms_step_mm(), with.max_step_mm.x(), without.rms_step_mm(), without.max_step_mm.x(), with.max_error_mm.x(),
        without.max_error_mm.x());
    EXPECT_LE(with.rms_step_mm(), 1.25 * without.rms_step_mm());
    EXPECT_LE(with.max_step_mm.x(), without.max_step_mm.x() + 0.5 * kRestingRadiusMm.x());
    EXPECT_LE(with.max_error_mm.x(), without.max_error_mm.x() + kRestingRadiusMm.x());
  }
}

TEST(DeadZone, without_noise_a_slow_motion_has_no_steps_at_all) {
  DeadZone zone(kRestingRadiusMm);
  double last = zone.follow({0, 0, 650}).x();
  for (int i = 1; i < 600; ++i) {
    const double x = zone.follow({i * 0.1, 0, 650}).x();  // 6 mm/s
    EXPECT_GE(x, last);
    EXPECT_LE(x - last, 0.2);
    last = x;
  }
  EXPECT_GT(last, 57.5);
}

TEST(DeadZone, does_not_delay_a_fast_head) {
  DeadZone zone(kRestingRadiusMm);
  double x = 0;
  for (int i = 0; i < 60; ++i) {
    x += 250.0 / 60;
    const double behind = x - zone.follow({x, 0, 650}).x();
    EXPECT_GE(behind, 0);
    if (i > 3) {
      EXPECT_LT(behind, 0.6);
    }
  }
}

}  // namespace
}  // namespace prismesh::drivers::eye_tracker

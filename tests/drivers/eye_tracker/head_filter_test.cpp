// Accuracy of the filter's predictions for head-like motion, and its reaction to late, missing and wrong samples.
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "drivers/eye_tracker/filter.h"
#include "tests/drivers/port/allocations.h"
#include "tests/support/head_trials.h"

namespace prismesh::drivers::eye_tracker {
namespace {

using Eigen::Vector3d;
using trials::Errors;
using trials::quantile;
using trials::Trial;

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kPeriod = 16'666'667;

/// The filter with the station's options.
struct Station {
  HeadFilter filter{HeadFilter::Options{}};
  void take(const HeadSample& sample) { filter.take(sample); }
  Vector3d ahead(double seconds) const {
    return predict(filter.state(), filter.state().time_ns + static_cast<std::int64_t>(seconds * 1e9));
  }
};
/// The tracker's samples without a filter.
struct Raw {
  Vector3d place = Vector3d::Zero();
  void take(const HeadSample& sample) { place = sample.between_eyes_mm; }
  Vector3d ahead(double) const { return place; }
};

constexpr int kSeeds = 120;    // for the required figures
constexpr int kFewSeeds = 25;  // for the other tests

/// The median over the seeds of a figure.
template <class Filter, class Figure>
double median(Trial trial, int seeds, Figure figure) {
  std::vector<double> figures;
  for (int seed = 1; seed <= seeds; ++seed) {
    trial.seed = static_cast<std::uint64_t>(seed);
    Filter filter;
    figures.push_back(figure(trials::run(trial, filter)));
  }
  return quantile(figures, 0.5);
}
double p99_mm(const Trial& trial, int seeds = kFewSeeds) {
  return median<Station>(trial, seeds, [](const Errors& errors) { return quantile(errors.distances_mm, 0.99); });
}
template <class Filter>
double jitter_mm(const Trial& trial, int seeds = kFewSeeds) {
  return median<Filter>(trial, seeds, [](const Errors& errors) { return errors.jitter_mm; });
}

HeadSample sample_at(std::int64_t time_ns, const Vector3d& place) {
  HeadSample sample;
  sample.measured_ns = time_ns;
  sample.between_eyes_mm = place;
  return sample;
}

/// A filter after two seconds of a head at constant velocity, without noise.
HeadFilter after_constant_velocity(const Vector3d& velocity_mm_s, std::int64_t* now_ns) {
  HeadFilter filter(HeadFilter::Options{});
  for (int i = 0; i <= 120; ++i) {
    *now_ns = 1'000 * kMs + i * kPeriod;
    filter.take(sample_at(*now_ns, Vector3d(0, 0, 650) + velocity_mm_s * (i * kPeriod * 1e-9)));
  }
  return filter;
}

TEST(HeadFilter, predicts_a_turning_head_within_8_mm_at_50_ms) {
  const double p99 = p99_mm({.kind = MotionKind::turn}, kSeeds);
  RecordProperty("p99_mm", std::to_string(p99));
  std::printf("turn at 412 mm/s, 50 ms ahead, 60 Hz, 1 mm: median of %d seeds' p99 = %.2f mm\n", kSeeds, p99);
  EXPECT_LE(p99, 8.0);  // the requirement
  EXPECT_LE(p99, 6.9);  // the achieved figure, with a small margin
}

TEST(HeadFilter, other_motions_are_easier) {
  EXPECT_LE(p99_mm({.kind = MotionKind::still}), 3.0);
  EXPECT_LE(p99_mm({.kind = MotionKind::sway}), 5.5);
  EXPECT_LE(p99_mm({.kind = MotionKind::lean}), 5.5);
  EXPECT_LE(p99_mm({.kind = MotionKind::tour}), 8.0);
}

TEST(HeadFilter, is_steadier_at_rest_than_the_tracker) {
  const Trial trial{.kind = MotionKind::still};
  const double raw = jitter_mm<Raw>(trial, kSeeds), ours = jitter_mm<Station>(trial, kSeeds);
  std::printf("change from sample to sample at rest, 50 ms ahead, rms an axis: raw %.2f mm, filtered %.2f mm\n", raw, ours);
  EXPECT_LT(ours, raw);         // the requirement
  EXPECT_LT(ours, 0.25 * raw);  // the achieved figure
  EXPECT_LT(jitter_mm<Station>({.kind = MotionKind::still, .ahead_s = 0.08}), raw);
}

TEST(HeadFilter, adapts_to_a_tracker_that_is_noisier_than_its_option) {
  const Trial trial{.kind = MotionKind::still, .noise_mm = 2.5};
  const double raw = jitter_mm<Raw>(trial), ours = jitter_mm<Station>(trial);
  std::printf("2.5 mm of noise where 1 mm was expected: jitter %.2f mm of %.2f mm\n", ours, raw);
  EXPECT_LT(ours, 0.3 * raw);
  EXPECT_LE(p99_mm({.kind = MotionKind::turn, .noise_mm = 2.5}), 13.5);
  Station station;
  trials::run({.kind = MotionKind::turn, .noise_mm = 2.5, .seconds = 20}, station);
  EXPECT_NEAR(station.filter.noise_mm(), 2.3, 0.4);
  Station quiet;
  trials::run({.kind = MotionKind::turn, .noise_mm = 0.2, .seconds = 20}, quiet);
  EXPECT_EQ(quiet.filter.noise_mm(), 1) << "as set: a tracker that smooths by itself may hide its noise";
}

TEST(HeadFilter, tolerates_lost_samples_and_uneven_times) {
  EXPECT_LE(p99_mm({.kind = MotionKind::turn, .lost_share = 0.2}), 8.5);
  EXPECT_LE(p99_mm({.kind = MotionKind::turn, .time_jitter_s = 0.003}), 7.0);
  EXPECT_LE(p99_mm({.kind = MotionKind::turn, .rate_hz = 30}), 10.5);
  EXPECT_LE(p99_mm({.kind = MotionKind::turn, .rate_hz = 120}), 6.0);
}

TEST(HeadFilter, stays_behind_a_steady_head_and_does_not_overshoot) {
  std::int64_t now = 0;
  const Vector3d velocity(400, 0, 0);
  const HeadFilter filter = after_constant_velocity(velocity, &now);
  const double there = 400 * 120 * kPeriod * 1e-9;
  EXPECT_NEAR(filter.state().between_eyes_mm.x(), there, 0.05);
  for (const std::int64_t ahead_ms : {20, 50, 80, 150, 200, 1000}) {
    const double truly = there + 400 * static_cast<double>(ahead_ms) * 1e-3;
    EXPECT_LT(predict(filter.state(), now + ahead_ms * kMs).x(), truly) << ahead_ms;
  }
  EXPECT_NEAR(predict(filter.state(), now + 50 * kMs).x(), there + 20, 1.2);
}

TEST(HeadFilter, predicts_up_to_200_ms_and_without_jumps) {
  HeadState state;
  EXPECT_EQ(predict(state, 5'000 * kMs), Vector3d::Zero());  // no head is known
  state = {1'000 * kMs, {10, 0, 650}, {100, 0, 0}, Vector3d::UnitX()};
  EXPECT_NEAR(predict(state, 1'050 * kMs).x(), 15, 1e-9);
  EXPECT_NEAR(predict(state, 950 * kMs).x(), 5, 1e-9);
  EXPECT_EQ(predict(state, 1'200 * kMs), predict(state, 9'000 * kMs));
  EXPECT_EQ(predict(state, 800 * kMs), predict(state, 0));
  double last = predict(state, 800 * kMs).x();
  for (std::int64_t t = 800; t <= 1300; ++t) {
    const double x = predict(state, t * kMs).x();
    EXPECT_GE(x, last);
    EXPECT_LE(x - last, 0.1 + 1e-9);
    last = x;
  }
}

TEST(HeadFilter, ignores_a_single_outlier) {
  std::int64_t now = 0;
  const Vector3d velocity(100, 0, 0);
  HeadFilter filter = after_constant_velocity(velocity, &now);
  const HeadState before = filter.state();
  for (const Vector3d& wild : {Vector3d(400, 0, 650), Vector3d(200, 30, 650), Vector3d(200, 0, 1650)}) {
    HeadFilter other = filter;
    other.take(sample_at(now + kPeriod, wild));
    EXPECT_EQ(other.state().time_ns, before.time_ns);
    EXPECT_EQ(other.state().between_eyes_mm, before.between_eyes_mm);
    other.take(sample_at(now + 2 * kPeriod, Vector3d(0, 0, 650) + velocity * (122 * kPeriod * 1e-9)));
    EXPECT_EQ(other.state().time_ns, now + 2 * kPeriod);
    EXPECT_NEAR(other.state().velocity_mm_s.x(), 95, 3);
  }
}

TEST(HeadFilter, restarts_at_several_agreeing_outliers) {
  std::int64_t now = 0;
  HeadFilter filter = after_constant_velocity({0, 0, 0}, &now);
  const Vector3d elsewhere(180, 20, 700);
  for (int i = 1; i <= 2; ++i) {
    filter.take(sample_at(now + i * kPeriod, elsewhere + Vector3d(i, 0, 0)));
    EXPECT_NEAR(filter.state().between_eyes_mm.x(), 0, 1e-6);
  }
  filter.take(sample_at(now + 3 * kPeriod, elsewhere));
  EXPECT_EQ(filter.state().between_eyes_mm, elsewhere);
  EXPECT_EQ(filter.state().velocity_mm_s, Vector3d::Zero());
}

TEST(HeadFilter, two_alternating_heads_do_not_become_one_fast_head) {
  std::int64_t now = 0;
  HeadFilter filter = after_constant_velocity({0, 0, 0}, &now);
  for (int i = 1; i < 60; ++i) {
    filter.take(sample_at(now + i * kPeriod, i % 2 ? Vector3d(250, 0, 650) : Vector3d(0, 0, 650)));
    EXPECT_NEAR(filter.state().between_eyes_mm.x(), 0, 1e-6);
  }
}

TEST(HeadFilter, restarts_after_a_long_gap_but_not_after_a_short_one) {
  std::int64_t now = 0;
  const HeadFilter filter = after_constant_velocity({100, 0, 0}, &now);
  HeadFilter shortly = filter, late = filter;
  const auto truly = [&](std::int64_t gap_ms) { return Vector3d(200 + 0.1 * static_cast<double>(gap_ms), 0, 650); };
  shortly.take(sample_at(now + 150 * kMs, truly(150)));
  EXPECT_GT(shortly.state().velocity_mm_s.x(), 80);
  late.take(sample_at(now + 400 * kMs, truly(400)));
  EXPECT_EQ(late.state().velocity_mm_s, Vector3d::Zero());
  EXPECT_EQ(late.state().between_eyes_mm, truly(400));
}

TEST(HeadFilter, ignores_old_samples_and_numbers_that_arent_finite) {
  std::int64_t now = 0;
  HeadFilter filter = after_constant_velocity({50, 0, 0}, &now);
  const HeadState before = filter.state();
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInfinite = std::numeric_limits<double>::infinity();
  filter.take(sample_at(now, {0, 0, 650}));
  filter.take(sample_at(now - kPeriod, {0, 0, 650}));
  filter.take(sample_at(now + kPeriod, {kNan, 0, 650}));
  filter.take(sample_at(now + kPeriod, {0, kInfinite, 650}));
  HeadSample blind = sample_at(now + kPeriod, {100, 0, 650});
  blind.toward_right.z() = kNan;
  filter.take(blind);
  EXPECT_EQ(filter.state().time_ns, before.time_ns);
  EXPECT_EQ(filter.state().between_eyes_mm, before.between_eyes_mm);
}

TEST(HeadFilter, doubtful_samples_have_less_weight) {
  std::int64_t now = 0;
  const HeadFilter filter = after_constant_velocity({0, 0, 0}, &now);
  HeadFilter sure = filter, unsure = filter;
  HeadSample sample = sample_at(now + kPeriod, {4, 0, 650});
  sure.take(sample);
  sample.doubtful = true;
  unsure.take(sample);
  EXPECT_GT(unsure.state().between_eyes_mm.x(), 0);
  EXPECT_LT(unsure.state().between_eyes_mm.x(), 0.5 * sure.state().between_eyes_mm.x());
}

TEST(HeadFilter, smooths_the_direction_between_the_eyes) {
  HeadFilter filter(HeadFilter::Options{});
  HeadSample sample = sample_at(1'000 * kMs, {0, 0, 650});
  sample.toward_right = Vector3d(2, 0, 0);
  filter.take(sample);
  EXPECT_EQ(filter.state().toward_right, Vector3d::UnitX());
  sample.toward_right = Vector3d(std::cos(0.3), std::sin(0.3), 0);
  double last = 0;
  for (int i = 1; i <= 60; ++i) {
    sample.measured_ns += kPeriod;
    filter.take(sample);
    const double angle = std::atan2(filter.state().toward_right.y(), filter.state().toward_right.x());
    EXPECT_NEAR(filter.state().toward_right.norm(), 1, 1e-12);
    EXPECT_GT(angle, last);
    EXPECT_LT(angle - last, 0.05);
    last = angle;
  }
  EXPECT_NEAR(last, 0.3, 0.01);
  sample.toward_right = Vector3d::Zero();
  sample.measured_ns += kPeriod;
  filter.take(sample);
  EXPECT_NEAR(filter.state().toward_right.norm(), 1, 1e-12);
}

TEST(HeadFilter, stays_finite_for_any_input) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> place(-5000, 5000), share(0, 1);
  HeadFilter filter(HeadFilter::Options{});
  std::int64_t now = 1'000 * kMs;
  for (int i = 0; i < 200'000; ++i) {
    now += static_cast<std::int64_t>(std::pow(share(random), 8) * 400e6) + (share(random) < 0.9 ? 1 : 0);
    HeadSample sample =
        sample_at(now, share(random) < 0.3 ? Vector3d(place(random), place(random), place(random)) : Vector3d(place(random) / 500, 0, 650));
    sample.doubtful = share(random) < 0.1;
    filter.take(sample);
    ASSERT_TRUE(filter.state().between_eyes_mm.allFinite());
    ASSERT_TRUE(filter.state().velocity_mm_s.allFinite());
    ASSERT_GE(filter.moving_probability(), 0);
    ASSERT_LE(filter.moving_probability(), 1);
  }
}

TEST(HeadFilter, allocates_nothing) {
  HeadFilter filter(HeadFilter::Options{});
  DeadZone zone(kRestingRadiusMm);
  const std::uint64_t before = port::allocations_of_this_thread();
  Vector3d sum = Vector3d::Zero();
  for (int i = 0; i < 1000; ++i) {
    filter.take(sample_at(1'000 * kMs + i * kPeriod, {i % 100 < 3 ? 300.0 : 0.3 * i, 0, 650}));
    sum += zone.follow(predict(filter.state(), 1'050 * kMs + i * kPeriod));
  }
  EXPECT_EQ(port::allocations_of_this_thread(), before);
  EXPECT_TRUE(sum.allFinite());
}

TEST(HeadFilter, reset_forgets_everything) {
  std::int64_t now = 0;
  HeadFilter filter = after_constant_velocity({50, 0, 0}, &now);
  filter.reset();
  EXPECT_EQ(filter.state().time_ns, 0);
  EXPECT_EQ(filter.moving_probability(), 0);
  filter.take(sample_at(5 * kMs, {1, 2, 600}));  // an earlier time is accepted after a reset
  EXPECT_EQ(filter.state().between_eyes_mm, Vector3d(1, 2, 600));
}

}  // namespace
}  // namespace prismesh::drivers::eye_tracker

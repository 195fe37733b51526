#include "drivers/eye_tracker/filter.h"

#include <algorithm>
#include <cmath>

namespace prismesh::drivers::eye_tracker {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Model parameters of heads and trackers; docs/prediction.md explains how the values were found.
constexpr double kDriftMm2PerS3 = 30;                     // resting: spectral density of the noise in the velocity
constexpr double kAccelerationMmPerS2 = 900;              // moving: standard deviation of the acceleration
constexpr double kAccelerationTimeS = 0.2;                // moving: time constant of the acceleration
constexpr double kSwitchesPerSecond = 0.5;                // rate of switches between resting and moving
constexpr double kLeadS = 0.05;                           // the published velocity is the predicted mean over this time,
constexpr double kLeadShare = 0.95;                       // times this factor: falling behind the head is better than overshooting
constexpr double kFirstSpeedMmPerS = 200;                 // standard deviation for a newly found head
constexpr double kMinProbability = 1e-4;                  // keeps each model possible
constexpr double kDoubtfulNoise = 3;                      // factor on the noise of a doubtful sample
constexpr double kOutlierSigmas = 7, kOutlierMm = 12;     // a sample beyond both is an outlier
constexpr double kAgreeMm = 12, kAgreeMmPerS = 1000;      // max. distance between two samples of one head: a constant plus this speed
constexpr int kAgreeingOutliers = 3;                      // so many consecutive agreeing outliers restart the filter
constexpr double kScatterShare = 1.0 / 60;                // weight of a new sample in the scatter
constexpr double kScatterTrust = 0.8, kMaxScatterMm = 8;  // factor for the uncertainty of the scatter; max. noise of a tracker
constexpr double kScatterGapS = 0.04;                     // for larger gaps between samples, the scatter is dominated by the head's motion
constexpr std::int64_t kGapNs = 250'000'000;
constexpr double kMaxStepS = 0.02;        // the moving model's noise is a series expansion in time / kAccelerationTimeS
constexpr double kDirectionTimeS = 0.15;  // time constant of the smoothed direction between the eyes

enum Row { kPosition, kVelocity, kAcceleration };

struct Step {
  Matrix3d forward;
  Matrix3d noise;
};

/// Constant velocity with noise.
Step resting_step(double t) {
  Step step{Matrix3d::Zero(), Matrix3d::Zero()};
  step.forward.topLeftCorner<2, 2>() << 1, t, 0, 1;
  step.noise.topLeftCorner<2, 2>() << t * t * t / 3, t * t / 2, t * t / 2, t;
  step.noise *= kDriftMm2PerS3;
  return step;
}

/// Acceleration with exponential autocorrelation [Singer 1970].
Step moving_step(double t) {
  constexpr double kRate = 1 / kAccelerationTimeS;
  const double kept = std::exp(-kRate * t);
  Step step;
  step.forward << 1, t, (kRate * t - 1 + kept) / (kRate * kRate), 0, 1, (1 - kept) / kRate, 0, 0, kept;
  const double t2 = t * t, t3 = t2 * t, t4 = t3 * t;
  step.noise << t4 * t / 20, t4 / 8, t3 / 6, t4 / 8, t3 / 3, t2 / 2, t3 / 6, t2 / 2, t;
  step.noise *= 2 * kRate * kAccelerationMmPerS2 * kAccelerationMmPerS2;
  return step;
}

double seconds_between(std::int64_t from_ns, std::int64_t until_ns) { return static_cast<double>(until_ns - from_ns) * 1e-9; }

}  // namespace

Vector3d predict(const HeadState& state, std::int64_t time_ns) {
  if (state.time_ns == 0) return state.between_eyes_mm;
  // Beyond the knee the predicted motion slows down, and stops at the max. prediction time.
  constexpr double kKneeS = 0.08, kMaxS = static_cast<double>(kMaxPredictionNs) * 1e-9, kBend = 0.5 / (kMaxS - kKneeS);
  double ahead = std::clamp(seconds_between(state.time_ns, time_ns), -kMaxS, kMaxS);
  if (ahead > kKneeS) ahead -= kBend * (ahead - kKneeS) * (ahead - kKneeS);
  return state.between_eyes_mm + state.velocity_mm_s * ahead;
}

HeadFilter::HeadFilter(const Options& options) : options_(options) { reset(); }

double HeadFilter::noise_mm() const { return std::max(options_.noise_mm, std::sqrt(kScatterTrust * scatter_mm2_)); }

void HeadFilter::reset() {
  state_ = {};
  mixture_.moving = 0;
  outlier_count_ = 0;
  scatter_mm2_ = options_.noise_mm * options_.noise_mm;
  recent_ = {};
}

void HeadFilter::take(const HeadSample& sample) {
  if (!sample.between_eyes_mm.allFinite() || !sample.toward_right.allFinite()) return;
  if (state_.time_ns != 0 && sample.measured_ns <= state_.time_ns) return;
  if (state_.time_ns == 0 || sample.measured_ns - state_.time_ns > kGapNs) {
    start(sample);
    return;
  }
  const double noise = noise_mm() * (sample.doubtful ? kDoubtfulNoise : 1);
  Mixture next = predicted(mixture_, seconds_between(state_.time_ns, sample.measured_ns));
  if (!plausible(next, sample.between_eyes_mm, noise * noise)) {
    take_outlier(sample);
    return;
  }
  update(next, sample.between_eyes_mm, noise * noise);
  mixture_ = next;
  if (!sample.doubtful) estimate_noise(sample);
  outlier_count_ = 0;
  publish(sample);
}

void HeadFilter::start(const HeadSample& sample) {
  Estimate first{Matrix3d::Zero(), Matrix3d::Zero()};
  first.mean.row(kPosition) = sample.between_eyes_mm.transpose();
  first.covariance.diagonal() << options_.noise_mm * options_.noise_mm, kFirstSpeedMmPerS * kFirstSpeedMmPerS, 0;
  mixture_.models.fill(first);
  mixture_.models[kMoving].covariance(kAcceleration, kAcceleration) = kAccelerationMmPerS2 * kAccelerationMmPerS2;
  mixture_.moving = 0.5;
  outlier_count_ = 0;
  const bool has_direction = sample.toward_right.norm() > 1e-3;
  state_ = {sample.measured_ns, sample.between_eyes_mm, Vector3d::Zero(),
            has_direction ? Vector3d(sample.toward_right.normalized()) : Vector3d(Vector3d::UnitX())};
}

/// The middle one of three samples deviates from the line between the others almost only by noise: even a fast head turn bends the path by
/// half a millimetre only.
void HeadFilter::estimate_noise(const HeadSample& sample) {
  const auto& [middle, first] = recent_;
  const double before = seconds_between(first.measured_ns, middle.measured_ns),
               after = seconds_between(middle.measured_ns, sample.measured_ns);
  if (first.measured_ns != 0 && before > 0 && before <= kScatterGapS && after > 0 && after <= kScatterGapS) {
    const double share = before / (before + after);
    const Vector3d line = (1 - share) * first.between_eyes_mm + share * sample.between_eyes_mm;
    const double unit = 1 + share * share + (1 - share) * (1 - share);
    const double scatter = (middle.between_eyes_mm - line).squaredNorm() / (3 * unit);
    scatter_mm2_ += kScatterShare * (std::min(scatter, kMaxScatterMm * kMaxScatterMm) - scatter_mm2_);
  }
  recent_ = {sample, middle};
}

/// Restarts the filter when several consecutive outliers agree: then the head is really elsewhere.
void HeadFilter::take_outlier(const HeadSample& sample) {
  const double apart = (sample.between_eyes_mm - outlier_.between_eyes_mm).norm();
  const bool newer = sample.measured_ns > outlier_.measured_ns;
  if (outlier_count_ > 0 && !newer) return;
  const bool agrees = outlier_count_ > 0 && apart <= kAgreeMm + kAgreeMmPerS * seconds_between(outlier_.measured_ns, sample.measured_ns);
  outlier_count_ = agrees ? outlier_count_ + 1 : 1;
  outlier_ = sample;
  if (outlier_count_ >= kAgreeingOutliers) start(sample);
}

/// Predicts the mixture by `seconds`. Each model starts from a mix of both, weighted by the probability that the head switched between
/// resting and moving [Blom 1988].
HeadFilter::Mixture HeadFilter::predicted(const Mixture& now, double seconds) {
  const double change = 1 - std::exp(-kSwitchesPerSecond * seconds);
  Mixture next;
  next.moving = (1 - change) * now.moving + change * (1 - now.moving);
  const std::array<double, 2> chance_now = {1 - now.moving, now.moving};
  const std::array<double, 2> chance_next = {1 - next.moving, next.moving};
  const int steps = std::max(1, static_cast<int>(std::ceil(seconds / kMaxStepS)));
  const std::array<Step, 2> step = {resting_step(seconds / steps), moving_step(seconds / steps)};
  for (std::size_t i = 0; i < 2; ++i) {
    const Estimate& own = now.models[i];
    const Estimate& other = now.models[1 - i];
    const double stayed = (1 - change) * chance_now[i] / chance_next[i];
    const Matrix3d apart = own.mean - other.mean;
    Estimate& to = next.models[i];
    to.mean = other.mean + stayed * apart;
    // The axes share one covariance, so the models' disagreement is averaged over the three axes.
    to.covariance = stayed * own.covariance + (1 - stayed) * other.covariance + (stayed * (1 - stayed) / 3) * apart * apart.transpose();
    for (int n = 0; n < steps; ++n) {
      to.mean = (step[i].forward * to.mean).eval();
      to.covariance = (step[i].forward * to.covariance * step[i].forward.transpose() + step[i].noise).eval();
    }
  }
  return next;
}

bool HeadFilter::plausible(const Mixture& predicted, const Vector3d& position_mm, double variance) {
  const Estimate& moving = predicted.models[kMoving];
  const double innovation = (position_mm - moving.mean.row(kPosition).transpose()).norm();
  return innovation <= std::max(kOutlierMm, kOutlierSigmas * std::sqrt(moving.covariance(kPosition, kPosition) + variance));
}

/// Updates both models (Kalman) and the models' probabilities (Bayes).
void HeadFilter::update(Mixture& predicted, const Vector3d& position_mm, double variance) {
  std::array<double, 2> log_likelihood{};
  for (std::size_t i = 0; i < 2; ++i) {
    Estimate& model = predicted.models[i];
    const Eigen::RowVector3d innovation = position_mm.transpose() - model.mean.row(kPosition);
    const double expected = model.covariance(kPosition, kPosition) + variance;
    const Vector3d gain = model.covariance.col(kPosition) / expected;
    log_likelihood[i] = -0.5 * innovation.squaredNorm() / expected - 1.5 * std::log(expected);
    model.mean += gain * innovation;
    model.covariance -= expected * gain * gain.transpose();
  }
  const double odds =
      (1 - predicted.moving) / predicted.moving * std::exp(std::clamp(log_likelihood[kResting] - log_likelihood[kMoving], -50.0, 50.0));
  predicted.moving = std::clamp(1 / (1 + odds), kMinProbability, 1 - kMinProbability);
}

void HeadFilter::publish(const HeadSample& sample) {
  const Matrix3d mean = (1 - mixture_.moving) * mixture_.models[kResting].mean + mixture_.moving * mixture_.models[kMoving].mean;
  // An acceleration changes the mean velocity over a time by half of what it changes the final velocity.
  const Vector3d lead = mean.row(kVelocity).transpose() + 0.5 * kLeadS * mean.row(kAcceleration).transpose();
  const double turned = 1 - std::exp(-seconds_between(state_.time_ns, sample.measured_ns) / kDirectionTimeS);
  const Vector3d direction = state_.toward_right + turned * (sample.toward_right - state_.toward_right);
  state_.time_ns = sample.measured_ns;
  state_.between_eyes_mm = mean.row(kPosition).transpose();
  state_.velocity_mm_s = kLeadShare * lead;
  if (direction.norm() > 1e-3) state_.toward_right = direction.normalized();
}

Vector3d DeadZone::follow(const Vector3d& position_mm) {
  if (!held_) {
    position_mm_ = position_mm;
    held_ = true;
    return position_mm_;
  }
  for (int axis = 0; axis < 3; ++axis) {
    const double radius = radius_mm_[axis];
    const double away = position_mm[axis] - position_mm_[axis];
    const double beyond = std::abs(away) - radius;
    if (beyond <= 0) continue;
    // Distance that the held position stays behind: the radius at the zone's edge, and less for larger steps.
    const double behind = radius > 0 ? radius * std::exp(-beyond / radius) : 0;
    position_mm_[axis] = position_mm[axis] - std::copysign(behind, away);
  }
  return position_mm_;
}

}  // namespace prismesh::drivers::eye_tracker

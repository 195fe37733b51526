#include "drivers/eye_tracker/filter.h"

#include <algorithm>
#include <cmath>

namespace prismesh::drivers::eye_tracker {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// What is assumed of heads and trackers; docs/prediction.md says how the values were found.
constexpr double kDriftMm2PerS3 = 30;                      // at rest: spectral density of what changes the velocity
constexpr double kAccelerationMmPerS2 = 900;               // moving: standard deviation of the acceleration ...
constexpr double kAccelerationLastsS = 0.2;                // ... and how long one lasts
constexpr double kChangesPerSecond = 0.5;                  // between resting and moving
constexpr double kLeadS = 0.05;                            // the published velocity is the mean over this time to come ...
constexpr double kLeadShare = 0.95;                        // ... of which so much is used: rather behind the head than beyond it
constexpr double kFirstSpeedMmPerS = 200;                  // standard deviation for a head that was just found
constexpr double kMinChance = 1e-4;                        // no model is ever ruled out
constexpr double kDoubtfulNoise = 3;                       // times the noise of an ordinary sample
constexpr double kWildSigmas = 7, kWildMm = 12;            // surprises beyond both are no head's
constexpr double kAgreeMm = 12, kAgreeMmPerS = 1000;       // two samples are of one head
constexpr int kAgreeing = 3;                               // so many that agree with each other are believed
constexpr double kScatterShare = 1.0 / 60;                 // of a new sample in the scatter ...
constexpr double kScatterTrust = 0.8, kScatterMostMm = 8;  // ... which is uncertain, and no tracker is as bad as that
constexpr double kScatterGapS = 0.04;                      // samples farther apart tell of the head rather than of noise
constexpr std::int64_t kGapNs = 250'000'000;
constexpr double kMaxStepS = 0.02;      // the moving model's noise is a series in time over kAccelerationLastsS
constexpr double kAcrossLastsS = 0.15;  // smoothing of the line between the eyes

enum Row { kPlace, kVelocity, kAcceleration };

struct Step {
  Matrix3d forward;
  Matrix3d noise;
};

/// Constant velocity, disturbed a little.
Step resting_step(double t) {
  Step step{Matrix3d::Zero(), Matrix3d::Zero()};
  step.forward.topLeftCorner<2, 2>() << 1, t, 0, 1;
  step.noise.topLeftCorner<2, 2>() << t * t * t / 3, t * t / 2, t * t / 2, t;
  step.noise *= kDriftMm2PerS3;
  return step;
}

/// An acceleration that comes and goes.
Step moving_step(double t) {
  constexpr double kRate = 1 / kAccelerationLastsS;
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
  // Beyond the knee the way ahead bends over, to end level at the longest prediction.
  constexpr double kKneeS = 0.08, kMaxS = static_cast<double>(kMaxPredictionNs) * 1e-9, kBend = 0.5 / (kMaxS - kKneeS);
  double ahead = std::clamp(seconds_between(state.time_ns, time_ns), -kMaxS, kMaxS);
  if (ahead > kKneeS) ahead -= kBend * (ahead - kKneeS) * (ahead - kKneeS);
  return state.between_eyes_mm + state.velocity_mm_s * ahead;
}

HeadFilter::HeadFilter(const Options& options) : options_(options) { reset(); }

double HeadFilter::noise_mm() const { return std::max(options_.noise_mm, std::sqrt(kScatterTrust * scatter_mm2_)); }

void HeadFilter::reset() {
  state_ = {};
  belief_.moving = 0;
  aside_count_ = 0;
  scatter_mm2_ = options_.noise_mm * options_.noise_mm;
  heard_ = {};
}

void HeadFilter::take(const HeadSample& sample) {
  if (!sample.between_eyes_mm.allFinite() || !sample.toward_right.allFinite()) return;
  if (state_.time_ns != 0 && sample.measured_ns <= state_.time_ns) return;
  if (state_.time_ns == 0 || sample.measured_ns - state_.time_ns > kGapNs) {
    start(sample);
    return;
  }
  const double noise = noise_mm() * (sample.doubtful ? kDoubtfulNoise : 1);
  Belief next = foretold(belief_, seconds_between(state_.time_ns, sample.measured_ns));
  if (!believable(next, sample.between_eyes_mm, noise * noise)) {
    set_aside(sample);
    return;
  }
  weigh(next, sample.between_eyes_mm, noise * noise);
  belief_ = next;
  if (!sample.doubtful) listen_to_noise(sample);
  aside_count_ = 0;
  publish(sample);
}

void HeadFilter::start(const HeadSample& sample) {
  Estimate first{Matrix3d::Zero(), Matrix3d::Zero()};
  first.moment.row(kPlace) = sample.between_eyes_mm.transpose();
  first.covariance.diagonal() << options_.noise_mm * options_.noise_mm, kFirstSpeedMmPerS * kFirstSpeedMmPerS, 0;
  belief_.models.fill(first);
  belief_.models[kMoving].covariance(kAcceleration, kAcceleration) = kAccelerationMmPerS2 * kAccelerationMmPerS2;
  belief_.moving = 0.5;
  aside_count_ = 0;
  const bool has_direction = sample.toward_right.norm() > 1e-3;
  state_ = {sample.measured_ns, sample.between_eyes_mm, Vector3d::Zero(),
            has_direction ? Vector3d(sample.toward_right.normalized()) : Vector3d(Vector3d::UnitX())};
}

/// How far the middle one of three samples lies beside the line between the others is nearly all noise: even a head in a fast turn bends
/// its way by half a millimetre only.
void HeadFilter::listen_to_noise(const HeadSample& sample) {
  const auto& [middle, first] = heard_;
  const double before = seconds_between(first.measured_ns, middle.measured_ns),
               after = seconds_between(middle.measured_ns, sample.measured_ns);
  if (first.measured_ns != 0 && before > 0 && before <= kScatterGapS && after > 0 && after <= kScatterGapS) {
    const double share = before / (before + after);
    const Vector3d line = (1 - share) * first.between_eyes_mm + share * sample.between_eyes_mm;
    const double unit = 1 + share * share + (1 - share) * (1 - share);
    const double scatter = (middle.between_eyes_mm - line).squaredNorm() / (3 * unit);
    scatter_mm2_ += kScatterShare * (std::min(scatter, kScatterMostMm * kScatterMostMm) - scatter_mm2_);
  }
  heard_ = {sample, middle};
}

/// What was set aside is believed when several in a row agree: the head really is elsewhere.
void HeadFilter::set_aside(const HeadSample& sample) {
  const double apart = (sample.between_eyes_mm - aside_.between_eyes_mm).norm();
  const bool newer = sample.measured_ns > aside_.measured_ns;
  if (aside_count_ > 0 && !newer) return;
  const bool agrees = aside_count_ > 0 && apart <= kAgreeMm + kAgreeMmPerS * seconds_between(aside_.measured_ns, sample.measured_ns);
  aside_count_ = agrees ? aside_count_ + 1 : 1;
  aside_ = sample;
  if (aside_count_ >= kAgreeing) start(sample);
}

/// Each model goes on from what both knew, by the chance that the head has changed between resting and moving, to `seconds` later.
HeadFilter::Belief HeadFilter::foretold(const Belief& now, double seconds) {
  const double change = 1 - std::exp(-kChangesPerSecond * seconds);
  Belief next;
  next.moving = (1 - change) * now.moving + change * (1 - now.moving);
  const std::array<double, 2> chance_now = {1 - now.moving, now.moving};
  const std::array<double, 2> chance_next = {1 - next.moving, next.moving};
  const int steps = std::max(1, static_cast<int>(std::ceil(seconds / kMaxStepS)));
  const std::array<Step, 2> step = {resting_step(seconds / steps), moving_step(seconds / steps)};
  for (std::size_t i = 0; i < 2; ++i) {
    const Estimate& own = now.models[i];
    const Estimate& other = now.models[1 - i];
    const double stayed = (1 - change) * chance_now[i] / chance_next[i];
    const Matrix3d apart = own.moment - other.moment;
    Estimate& to = next.models[i];
    to.moment = other.moment + stayed * apart;
    // The axes have one covariance in common: what the models disagree by is spread over the three.
    to.covariance = stayed * own.covariance + (1 - stayed) * other.covariance + (stayed * (1 - stayed) / 3) * apart * apart.transpose();
    for (int n = 0; n < steps; ++n) {
      to.moment = (step[i].forward * to.moment).eval();
      to.covariance = (step[i].forward * to.covariance * step[i].forward.transpose() + step[i].noise).eval();
    }
  }
  return next;
}

bool HeadFilter::believable(const Belief& foretold, const Vector3d& place_mm, double variance) {
  const Estimate& moving = foretold.models[kMoving];
  const double surprise = (place_mm - moving.moment.row(kPlace).transpose()).norm();
  return surprise <= std::max(kWildMm, kWildSigmas * std::sqrt(moving.covariance(kPlace, kPlace) + variance));
}

/// Kalman's update of both models, and Bayes' of which is right.
void HeadFilter::weigh(Belief& foretold, const Vector3d& place_mm, double variance) {
  std::array<double, 2> log_likelihood{};
  for (std::size_t i = 0; i < 2; ++i) {
    Estimate& model = foretold.models[i];
    const Eigen::RowVector3d surprise = place_mm.transpose() - model.moment.row(kPlace);
    const double expected = model.covariance(kPlace, kPlace) + variance;
    const Vector3d gain = model.covariance.col(kPlace) / expected;
    log_likelihood[i] = -0.5 * surprise.squaredNorm() / expected - 1.5 * std::log(expected);
    model.moment += gain * surprise;
    model.covariance -= expected * gain * gain.transpose();
  }
  const double odds =
      (1 - foretold.moving) / foretold.moving * std::exp(std::clamp(log_likelihood[kResting] - log_likelihood[kMoving], -50.0, 50.0));
  foretold.moving = std::clamp(1 / (1 + odds), kMinChance, 1 - kMinChance);
}

void HeadFilter::publish(const HeadSample& sample) {
  const Matrix3d moment = (1 - belief_.moving) * belief_.models[kResting].moment + belief_.moving * belief_.models[kMoving].moment;
  // An acceleration changes the mean velocity over a time by half of what it changes the velocity.
  const Vector3d lead = moment.row(kVelocity).transpose() + 0.5 * kLeadS * moment.row(kAcceleration).transpose();
  const double turned = 1 - std::exp(-seconds_between(state_.time_ns, sample.measured_ns) / kAcrossLastsS);
  const Vector3d across = state_.toward_right + turned * (sample.toward_right - state_.toward_right);
  state_.time_ns = sample.measured_ns;
  state_.between_eyes_mm = moment.row(kPlace).transpose();
  state_.velocity_mm_s = kLeadShare * lead;
  if (across.norm() > 1e-3) state_.toward_right = across.normalized();
}

Vector3d DeadZone::follow(const Vector3d& place_mm) {
  if (!held_) {
    place_mm_ = place_mm;
    held_ = true;
    return place_mm_;
  }
  for (int axis = 0; axis < 3; ++axis) {
    const double radius = radius_mm_[axis];
    const double away = place_mm[axis] - place_mm_[axis];
    const double beyond = std::abs(away) - radius;
    if (beyond <= 0) continue;
    // How far the held place stays behind: all of the radius at the edge, less the further the head gets in one go.
    const double behind = radius > 0 ? radius * std::exp(-beyond / radius) : 0;
    place_mm_[axis] = place_mm[axis] - std::copysign(behind, away);
  }
  return place_mm_;
}

}  // namespace prismesh::drivers::eye_tracker

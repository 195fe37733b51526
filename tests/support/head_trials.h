// A filter of head positions on trial: a known motion, a tracker with noise, and the distances between predicted and true
// positions. Shared by the tests and by the benchmark, so that both measure the same figures.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <Eigen/Core>

#include "drivers/eye_tracker/eye_tracker.h"
#include "drivers/eye_tracker/head_motion.h"

namespace prismesh::drivers::eye_tracker::trials {

struct Trial {
  MotionKind kind = MotionKind::turn;
  std::uint64_t seed = 1;
  double noise_mm = 1;  ///< in each axis
  double rate_hz = 60;
  double ahead_s = 0.05;
  double seconds = 60;
  double lost_share = 0;     ///< of the samples
  double time_jitter_s = 0;  ///< standard deviation of the moments of measuring (which are known)
  double speed = 1;
};

struct Errors {
  std::vector<double> distances_mm;  ///< of the foretold place from the true one, at each sample
  std::vector<double> across_mm;     ///< the same across the screen (x) only: what the mask and the columns depend on
  std::vector<double> beyond_mm;     ///< just after a move: how far the foretold place is beyond the true one
  double jitter_mm = 0;  ///< root mean square change, from sample to sample and per axis, of the foretold place less the head's own change
};

/// The value that a share of them doesn't exceed. `values` aren't empty.
inline double quantile(std::vector<double> values, double share) {
  const auto at = std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

/// Finds out when a head has just stopped, and where it came from.
class JustStopped {
 public:
  /// The direction of the move that ended within the last quarter of a second; zero if there is none.
  Eigen::Vector3d direction(double seconds, const Eigen::Vector3d& velocity_mm_s) {
    if (velocity_mm_s.norm() >= 50) {
      direction_ = velocity_mm_s.normalized();
      moved_s_ = seconds;
    } else if (seconds - moved_s_ < 0.25) {
      return direction_;
    }
    return Eigen::Vector3d::Zero();
  }

 private:
  Eigen::Vector3d direction_ = Eigen::Vector3d::Zero();
  double moved_s_ = -1;
};

/// `Filter`: take(HeadSample), and ahead(seconds) giving the place so long after the newest sample.
template <class Filter>
Errors run(const Trial& trial, Filter& filter) {
  const HeadMotion motion(trial.kind, trial.seed, {0, 0, 650}, trial.speed);
  std::mt19937_64 random(trial.seed * 77 + 1);
  std::normal_distribution<double> normal(0, 1);
  std::uniform_real_distribution<double> share(0, 1);
  Errors errors;
  JustStopped just_stopped;
  double square_sum = 0;
  Eigen::Vector3d last = Eigen::Vector3d::Zero(), last_true = Eigen::Vector3d::Zero();
  const auto samples = static_cast<int>(trial.seconds * trial.rate_hz);
  for (int i = 0; i < samples; ++i) {
    const double t = i / trial.rate_hz + trial.time_jitter_s * normal(random);
    HeadSample sample;
    sample.measured_ns = 1'000'000'000 + static_cast<std::int64_t>(t * 1e9);
    const Eigen::Vector3d noise{normal(random), normal(random), normal(random)};
    sample.between_eyes_mm = motion.between_eyes_mm(t) + trial.noise_mm * noise;
    if (share(random) < trial.lost_share) continue;
    filter.take(sample);
    const Eigen::Vector3d foretold = filter.ahead(trial.ahead_s);
    const Eigen::Vector3d truly = motion.between_eyes_mm(t + trial.ahead_s);
    if (t > 1) {
      errors.distances_mm.push_back((foretold - truly).norm());
      errors.across_mm.push_back(std::abs((foretold - truly).x()));
      const Eigen::Vector3d direction = just_stopped.direction(t + trial.ahead_s, motion.velocity_mm_s(t + trial.ahead_s));
      if (!direction.isZero()) errors.beyond_mm.push_back((foretold - truly).dot(direction));
      square_sum += (foretold - last - (truly - last_true)).squaredNorm() / 3;
    }
    last = foretold;
    last_true = truly;
  }
  errors.jitter_mm = std::sqrt(square_sum / static_cast<double>(errors.distances_mm.size()));
  return errors;
}

}  // namespace prismesh::drivers::eye_tracker::trials

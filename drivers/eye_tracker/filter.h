// Filters head measurements and predicts the head's position. The filter's state (position, velocity, time) is published; each user
// extrapolates it to the time it needs. Fixed size, no allocation.
#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>

#include "drivers/eye_tracker/eye_tracker.h"

namespace prismesh::drivers::eye_tracker {

/// Position and velocity of the head.
struct HeadState {
  std::int64_t time_ns = 0;  ///< of the newest measurement; 0: no head is known
  Eigen::Vector3d between_eyes_mm = Eigen::Vector3d::Zero();
  /// The best velocity for extrapolation: the predicted mean over the next 50 ms, slightly underestimated.
  Eigen::Vector3d velocity_mm_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d toward_right = Eigen::Vector3d::UnitX();
};

inline constexpr std::int64_t kMaxPredictionNs = 200'000'000;
/// Returns the point between the eyes at a time. Extrapolates by max. kMaxPredictionNs forward or back. Slows the predicted motion down
/// from 80 ms on, since a fast head is about to stop.
Eigen::Vector3d predict(const HeadState& state, std::int64_t time_ns);

/// Estimates the head's motion with two models, one resting and one with random acceleration, weighted by how well each predicted the
/// newest measurement: interacting multiple models [Blom 1988]; the moving model follows [Singer 1970]. At rest the result
/// is steadier than the tracker; in a fast turn it isn't smoothed. docs/prediction.md compares it with other filters.
class HeadFilter {
 public:
  struct Options {
    double noise_mm = 1;  ///< min. standard deviation of the tracker's noise in each axis; see noise_mm()
  };
  explicit HeadFilter(const Options& options);

  /// Takes the next sample. Samples come in order of time, at any rate. Ignores a sample that isn't newer or isn't finite, and gives a
  /// doubtful one less weight. Doesn't use an outlier, which no head can reach in time. Restarts when the following outliers agree with it,
  /// or after a gap of a quarter of a second.
  void take(const HeadSample& sample);
  void reset();
  const HeadState& state() const { return state_; }
  /// Returns the probability that the head moves, 0..1.
  double moving_probability() const { return mixture_.moving; }
  /// Returns the assumed standard deviation of the tracker's noise: the option's value, or the scatter of the last second's samples if that
  /// is larger.
  double noise_mm() const;

 private:
  /// Mean position, velocity and acceleration (rows) of the three axes (columns), and their covariance, which the axes share.
  struct Estimate {
    Eigen::Matrix3d mean;
    Eigen::Matrix3d covariance;
  };
  enum Model : std::size_t { kResting, kMoving };
  struct Mixture {
    std::array<Estimate, 2> models;
    double moving = 0;  ///< probability of the second model
  };
  void start(const HeadSample& sample);
  void take_outlier(const HeadSample& sample);
  void publish(const HeadSample& sample);
  void estimate_noise(const HeadSample& sample);
  static Mixture predicted(const Mixture& now, double seconds);
  static bool plausible(const Mixture& predicted, const Eigen::Vector3d& position_mm, double variance);
  static void update(Mixture& predicted, const Eigen::Vector3d& position_mm, double variance);

  Options options_;
  Mixture mixture_;
  std::array<HeadSample, 2> recent_;  ///< the last two accepted samples, the newest first
  double scatter_mm2_ = 0;            ///< variance of the noise over about the last second
  HeadSample outlier_;                ///< the newest outlier
  int outlier_count_ = 0;
  HeadState state_;
};

/// Radii for DeadZone: a resting head under a tracker with 1 mm of noise stays inside. In depth a picture shows less of a motion.
inline const Eigen::Vector3d kRestingRadiusMm{2.0, 2.0, 5.0};

/// Suppresses small motions, so that an idle picture doesn't change: each axis follows only when the head leaves a zone around the held
/// position. It follows without a jump at the zone's edge, and more closely for faster motions.
class DeadZone {
 public:
  explicit DeadZone(const Eigen::Vector3d& radius_mm) : radius_mm_(radius_mm) {}
  Eigen::Vector3d follow(const Eigen::Vector3d& position_mm);
  void reset() { held_ = false; }

 private:
  Eigen::Vector3d radius_mm_;
  Eigen::Vector3d position_mm_ = Eigen::Vector3d::Zero();
  bool held_ = false;
};

}  // namespace prismesh::drivers::eye_tracker

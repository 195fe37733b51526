// From measurements to where the head will be: one filter for everybody. Its state (position, velocity, time) is published; whoever
// needs a place in the future extrapolates that state to a time of their own. Fixed size, no allocation.
#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>

#include "drivers/eye_tracker/eye_tracker.h"

namespace prismesh::drivers::eye_tracker {

/// Where the head is and goes.
struct HeadState {
  std::int64_t time_ns = 0;  ///< of the newest measurement in it; 0: nothing is known
  Eigen::Vector3d between_eyes_mm = Eigen::Vector3d::Zero();
  /// What extrapolates best: the mean velocity that is expected over the next 50 ms, a little under-estimated.
  Eigen::Vector3d velocity_mm_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d toward_right = Eigen::Vector3d::UnitX();
};

inline constexpr std::int64_t kMaxPredictionNs = 200'000'000;
/// The place between the eyes at a time: never extrapolated further than kMaxPredictionNs past the newest measurement (nor further
/// back before it), and from 80 ms on ever more slowly, since a head that moves fast is about to stop.
Eigen::Vector3d predict(const HeadState& state, std::int64_t time_ns);

/// Two models of a head run side by side, one at rest and one that accelerates at will, and are weighted by how well each foretold the
/// newest measurement (interacting multiple models; Blom and Bar-Shalom 1988, the moving one after Singer 1970). At rest the picture is
/// steadier than the tracker, in a fast turn nothing is smoothed away. docs/prediction.md compares it with others.
class HeadFilter {
 public:
  struct Options {
    double noise_mm = 1;  ///< the tracker's noise in each axis, standard deviation, at least; more is noticed, see noise_mm()
  };
  explicit HeadFilter(const Options& options);

  /// Samples come in the order of their times, at any rate; one that isn't newer or isn't finite is ignored. A doubtful one counts for
  /// less. One that lies where no head gets to in time is set aside; when the following ones agree with it, or after a gap of a
  /// quarter of a second, the filter starts anew.
  void take(const HeadSample& sample);
  void reset();
  const HeadState& state() const { return state_; }
  /// How sure it is that the head moves, 0..1.
  double moving() const { return belief_.moving; }
  /// What it takes the tracker's noise to be: as set, or what the last second's samples scatter by if that is more.
  double noise_mm() const;

 private:
  /// Place, velocity and acceleration (rows) of the three axes (columns), and the covariance that the axes have in common.
  struct Estimate {
    Eigen::Matrix3d moment;
    Eigen::Matrix3d covariance;
  };
  enum Model : std::size_t { kResting, kMoving };
  struct Belief {
    std::array<Estimate, 2> models;
    double moving = 0;  ///< the chance that the second model is right
  };
  void start(const HeadSample& sample);
  void set_aside(const HeadSample& sample);
  void publish(const HeadSample& sample);
  void listen_to_noise(const HeadSample& sample);
  static Belief foretold(const Belief& now, double seconds);
  static bool believable(const Belief& foretold, const Eigen::Vector3d& place_mm, double variance);
  static void weigh(Belief& foretold, const Eigen::Vector3d& place_mm, double variance);

  Options options_;
  Belief belief_;
  std::array<HeadSample, 2> heard_;  ///< the last two that were believed, the newest first
  double scatter_mm2_ = 0;           ///< variance of the noise as it was in the last second or so
  HeadSample aside_;                 ///< the newest of those that were set aside
  int aside_count_ = 0;
  HeadState state_;
};

/// Radii for DeadZone: a resting head under a tracker with 1 mm of noise stays within. In depth a picture shows less of a move.
inline const Eigen::Vector3d kRestingRadiusMm{2.0, 2.0, 5.0};

/// Holds still what hardly moves, so that an idle picture stays idle: each axis follows only where the head leaves a small zone around
/// the last place, and then softly: without a jump at the zone's edge, and all the closer the faster the head goes.
class DeadZone {
 public:
  explicit DeadZone(const Eigen::Vector3d& radius_mm) : radius_mm_(radius_mm) {}
  Eigen::Vector3d follow(const Eigen::Vector3d& place_mm);
  void reset() { held_ = false; }

 private:
  Eigen::Vector3d radius_mm_;
  Eigen::Vector3d place_mm_ = Eigen::Vector3d::Zero();
  bool held_ = false;
};

}  // namespace prismesh::drivers::eye_tracker

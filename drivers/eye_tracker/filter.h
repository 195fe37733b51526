// From measurements to where the head will be: one filter for everybody. Its state (position, velocity, time) is published; whoever
// needs a place in the future extrapolates that state to a time of their own. Fixed size, no allocation.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "drivers/eye_tracker/eye_tracker.h"

namespace prismesh::drivers::eye_tracker {

/// Where the head is and goes.
struct HeadState {
  std::int64_t time_ns = 0;  ///< of the newest measurement in it; 0: nothing is known
  Eigen::Vector3d between_eyes_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_mm_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d toward_right = Eigen::Vector3d::UnitX();
};

inline constexpr std::int64_t kLongestPredictionNs = 200'000'000;
/// The place between the eyes at a time: never extrapolated further than kLongestPredictionNs past the newest measurement.
Eigen::Vector3d predict(const HeadState& state, std::int64_t time_ns);

class HeadFilter {
 public:
  struct Options {
    double noise_mm = 1;  ///< standard deviation of the tracker's noise; the rest follows from it
  };
  explicit HeadFilter(const Options& options);

  /// Samples come in the order of their times; an older one is ignored, one after a long gap or a jump no head makes starts anew.
  void take(const HeadSample& sample);
  void reset();
  const HeadState& state() const { return state_; }

 private:
  Options options_;
  HeadState state_;
};

/// Holds still what hardly moves, so that an idle picture stays idle: follows only when the head leaves a small zone around the last place
/// (with a soft edge, so that nothing jumps when it does).
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

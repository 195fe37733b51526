#include "drivers/eye_tracker/filter.h"

#include <algorithm>
#include <cmath>

namespace prismesh::drivers::eye_tracker {

using Eigen::Vector3d;

Vector3d predict(const HeadState& state, std::int64_t time_ns) {
  if (state.time_ns == 0) return state.between_eyes_mm;
  const std::int64_t ahead = std::clamp(time_ns - state.time_ns, -kLongestPredictionNs, kLongestPredictionNs);
  return state.between_eyes_mm + state.velocity_mm_s * (static_cast<double>(ahead) * 1e-9);
}

HeadFilter::HeadFilter(const Options& options) : options_(options) {}

void HeadFilter::reset() { state_ = {}; }

void HeadFilter::take(const HeadSample& sample) {
  constexpr std::int64_t kGapNs = 250'000'000;
  constexpr double kPlaceGain = 0.5, kVelocityGain = kPlaceGain * kPlaceGain / (2 - kPlaceGain);
  if (!sample.between_eyes_mm.allFinite() || !sample.toward_right.allFinite()) return;
  if (state_.time_ns != 0 && sample.measured_ns <= state_.time_ns) return;
  if (state_.time_ns == 0 || sample.measured_ns - state_.time_ns > kGapNs) {
    state_ = {sample.measured_ns, sample.between_eyes_mm, Vector3d::Zero(), sample.toward_right};
    return;
  }
  const double seconds = static_cast<double>(sample.measured_ns - state_.time_ns) * 1e-9;
  const Vector3d expected = state_.between_eyes_mm + state_.velocity_mm_s * seconds;
  const Vector3d surprise = sample.between_eyes_mm - expected;
  state_ = {sample.measured_ns, expected + kPlaceGain * surprise, state_.velocity_mm_s + kVelocityGain / seconds * surprise,
            sample.toward_right};
}

Vector3d DeadZone::follow(const Vector3d& place_mm) {
  if (!held_) {
    place_mm_ = place_mm;
    held_ = true;
    return place_mm_;
  }
  for (int axis = 0; axis < 3; ++axis) {
    const double away = place_mm[axis] - place_mm_[axis];
    const double beyond = std::abs(away) - radius_mm_[axis];
    if (beyond > 0) place_mm_[axis] += std::copysign(beyond, away);
  }
  return place_mm_;
}

}  // namespace prismesh::drivers::eye_tracker

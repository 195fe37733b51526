#include "kiosk/toolkit/depth.h"

#include <algorithm>
#include <cmath>

namespace prismesh::kiosk::toolkit {

namespace {

constexpr double kDistanceStep = 0.08;  ///< share of the distance: smaller moves of the eyes keep the box as it is

/// 0 .. 1 with a soft start and end.
double progress(std::int64_t since_ns) {
  const double t = std::clamp(static_cast<double>(since_ns) / static_cast<double>(DepthFit::kGlideNs), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

}  // namespace

void DepthFit::change_percent(int steps) { percent_ = std::clamp(percent_ + steps * kPercentStep, 0, kMaxPercent); }

void DepthFit::change_degrees(int steps) {
  const auto tenths = [](double degrees) { return static_cast<int>(std::lround(10 * degrees)); };
  tenths_ = std::clamp(tenths_ + steps * tenths(kDegreesStep), tenths(kMinDegrees), tenths(kMaxDegrees));
}

void DepthFit::follow_distance(double eye_distance_mm, std::int64_t now_ns) {
  if (distance_mm_ <= 0) distance_mm_ = distance_goal_mm_ = eye_distance_mm;
  if (std::abs(eye_distance_mm - distance_goal_mm_) > kDistanceStep * distance_goal_mm_) {
    distance_glide_ = DistanceGlide{distance_mm_, now_ns};
    distance_goal_mm_ = eye_distance_mm;
  }
  if (!distance_glide_) return;
  const double share = progress(now_ns - distance_glide_->begun_ns);
  distance_mm_ = distance_glide_->from_mm + share * (distance_goal_mm_ - distance_glide_->from_mm);
  if (share >= 1) distance_glide_.reset();
}

stereo::View DepthFit::fitted(const stereo::View& view, const stereo::Vec3& between_eyes_mm, std::int64_t now_ns) {
  follow_distance(between_eyes_mm.z(), now_ns);
  stereo::View fitted = view;
  fitted.comfort = stereo::comfort_box(distance_mm_, degrees());
  fitted.depth_strength = 0.01 * percent_;
  if (!glide_) return fitted;
  // The remaining distance shrinks by the same share even if the view has changed meanwhile.
  const double left_before = 1 - progress(glide_->last_ns - glide_->begun_ns), left = 1 - progress(now_ns - glide_->begun_ns);
  fitted = stereo::toward_screen_plane(fitted, glide_->point, between_eyes_mm, left_before > 0 ? 1 - left / left_before : 1);
  glide_->last_ns = now_ns;
  if (left <= 0) glide_.reset();
  return fitted;
}

}  // namespace prismesh::kiosk::toolkit

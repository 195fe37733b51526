// Fits the depth of the picture to the eyes, and moves a point into the plane of the screen. Pure; times are passed in.
#pragma once

#include <cstdint>
#include <optional>

#include "kiosk/stereo/view.h"

namespace prismesh::kiosk::toolkit {

class DepthFit {
 public:
  static constexpr int kMaxPercent = 150, kPercentStep = 10;
  static constexpr double kMinDegrees = 0.5, kMaxDegrees = 1.5, kDegreesStep = 0.1;
  static constexpr std::int64_t kGlideNs = 180'000'000;

  /// 0 .. 150 % of the fitted depth.
  int percent() const { return percent_; }
  void change_percent(int steps);
  /// Parallax that counts as comfortable.
  double degrees() const { return 0.1 * tenths_; }
  void change_degrees(int steps);
  bool keeps_selection() const { return keeps_selection_; }
  void keep_selection(bool keep) { keeps_selection_ = keep; }

  /// Moves the point into the plane of the screen within kGlideNs.
  void bring(const stereo::Vec3& point, std::int64_t now_ns) { glide_ = Glide{point, now_ns, now_ns}; }
  /// The view still moves.
  bool moving() const { return glide_.has_value() || distance_glide_.has_value(); }

  /// The view for now, seen from between these eyes. Follows their distance in steps, so that a swaying head doesn't change the depth all
  /// the time.
  stereo::View fitted(const stereo::View& view, const stereo::Vec3& between_eyes_mm, std::int64_t now_ns);

 private:
  struct Glide {
    stereo::Vec3 point;
    std::int64_t begun_ns = 0;
    std::int64_t last_ns = 0;
  };
  struct DistanceGlide {
    double from_mm = 0;
    std::int64_t begun_ns = 0;
  };
  void follow_distance(double eye_distance_mm, std::int64_t now_ns);

  int percent_ = 100;
  int tenths_ = 10;
  bool keeps_selection_ = false;
  std::optional<Glide> glide_;
  double distance_mm_ = 0;  ///< of the eyes, as the comfort box was last set up for; 0: not yet
  double distance_goal_mm_ = 0;
  std::optional<DistanceGlide> distance_glide_;
};

}  // namespace prismesh::kiosk::toolkit

// Computes the eye positions that a picture is drawn for: predicted to the time the picture lights up, constant while the head is still,
// and mono whenever the eyes or the mask aren't known well enough for depth. The device daemon's state and all times are arguments.
//
// Guarantee: a display whose picture is right only at the position it was woven for shows no depth later than 250 ms after the last good
// measurement, whichever part fails (the tracker, its line, the daemon, the link to it). It holds if a picture takes at most 70 ms to draw.
#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "drivers/display/eyes.h"
#include "drivers/eye_tracker/filter.h"
#include "ipc/device/page.h"
#include "kiosk/stereo/lit_time.h"

namespace prismesh::kiosk::stereo {

/// The device daemon's page as last read; empty what is missing or couldn't be read.
struct DeviceReading {
  std::optional<ipc::EyesState> eyes;
  std::optional<ipc::PrismState> prism;
};

/// How the display follows the eyes, and their position while it isn't known.
struct FollowOptions {
  bool follow = true;             ///< false: the eyes stay at `resting_mm`, in full depth
  bool mono_without_eyes = true;  ///< an eye gets its picture only at the position it is woven for; false: glasses separate the pictures
  bool movable_mask = true;       ///< show depth only while the mask follows
  Eigen::Vector3d resting_mm{0, 0, 650};
  std::optional<double> eye_separation_mm;  ///< measured with this viewer; empty: the tracker's
  bool operator==(const FollowOptions&) const = default;
};

/// Limits for TrackedEyes, with their defaults.
struct FollowLimits {
  /// Time from the last good measurement until the picture is mono. The rest of the 250 ms is reserved for a missed refresh and for a
  /// picture that takes longer to draw than the last ones.
  std::int64_t mono_after_ns = 210'000'000;
  std::int64_t lost_after_ns = 100'000'000;     ///< without a measurement for this time the fade to mono begins ...
  std::int64_t min_lost_after_ns = 60'000'000;  ///< ... earlier, down to this, if pictures take long to draw
  std::int64_t fade_ns = 80'000'000;            ///< duration of the fade to mono when the mask stops following, and before it moves back
  std::int64_t rise_ns = 200'000'000;           ///< duration of the rise from mono to full depth
  std::int64_t mask_old_ns = 100'000'000;       ///< an older state of the mask is ignored
  std::int64_t rest_after_ns = 1'000'000'000;   ///< without a measurement for this time the eyes move slowly to the resting position
  double place_slack_mm = 30;                   ///< no depth while the picture's eyes are farther from the real ones
  double mask_step_mm = 0.005;                  ///< a smaller movement of the mask (0.02 pixels) is ignored
};

/// Eyes and mask that the picture is drawn for.
struct SeenFrom {
  Eigen::Vector3d between_eyes_mm{0, 0, 650};
  Eigen::Vector3d toward_right = Eigen::Vector3d::UnitX();
  double eye_separation_mm = drivers::display::kMeanEyeSeparationMm;
  double depth_share = 1;         ///< 0: mono
  std::optional<double> mask_mm;  ///< empty: the ideal position for these eyes
  bool operator==(const SeenFrom&) const = default;
};

class TrackedEyes {
 public:
  explicit TrackedEyes(const FollowOptions& options, const FollowLimits& limits = {});

  void set_options(const FollowOptions& options);
  const FollowOptions& options() const { return options_; }
  const FollowLimits& limits() const { return limits_; }
  /// Call about once for each refresh, whether or not a picture is drawn. If two results are equal, the picture may stay.
  SeenFrom look(const DeviceReading& reading, std::int64_t now_ns, const LitTime& lit);
  /// The last result in mono, for a picture that is shown so; depth rises again from there.
  SeenFrom flatten();
  /// Time of the newest good measurement; 0: none yet.
  std::int64_t measured_ns() const { return head_.time_ns; }

 private:
  /// A position in millimetres that follows a target. It is constant while the target stays within a zone, and a change to another target
  /// is gradual.
  class Glide {
   public:
    Glide(double across_mm, double deep_mm) : zone_(Eigen::Vector3d(across_mm, across_mm, deep_mm)) {}
    void begin(const Eigen::Vector3d& at);
    /// The next target is another one: the shown position moves to it gradually.
    void retarget() { fresh_target_ = true; }
    Eigen::Vector3d follow(const Eigen::Vector3d& target, double seconds, double time_constant_s);
    double offset_mm() const { return offset_.norm(); }

   private:
    drivers::eye_tracker::DeadZone zone_;
    Eigen::Vector3d shown_ = Eigen::Vector3d::Zero();
    Eigen::Vector3d offset_ = Eigen::Vector3d::Zero();
    bool fresh_target_ = false;
  };
  enum class Source : std::uint8_t { resting, tracked };

  void take(const DeviceReading& reading, std::int64_t now_ns);
  void move(std::int64_t now_ns, const LitTime& lit);
  std::int64_t heard_ns() const { return head_.time_ns + slow_ns_; }
  double share_for_eyes(std::int64_t now_ns, const LitTime& lit) const;
  double share_for_mask(const DeviceReading& reading, std::int64_t now_ns, const LitTime& lit);
  void follow_mask(const DeviceReading& reading, const LitTime& lit);

  FollowOptions options_;
  FollowLimits limits_;
  drivers::eye_tracker::HeadState head_;
  std::int64_t slow_ns_ = 0;  ///< additional age of measurements when they arrive, as with a webcam
  double eye_separation_mm_ = drivers::display::kMeanEyeSeparationMm;
  Source source_ = Source::resting;
  bool found_again_ = false;  ///< measurements came back after they were lost
  Glide place_;
  Glide half_separation_;                      ///< vector from between the eyes to the right one
  std::optional<std::int64_t> disallowed_ns_;  ///< until_ns of the first picture after the mask stopped following
  std::optional<std::int64_t> looked_ns_;      ///< from_ns of the last look
  SeenFrom seen_;
};

}  // namespace prismesh::kiosk::stereo

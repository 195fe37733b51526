// The eyes that a picture is drawn for: predicted to the moment it lights up, still while the head is, and mono whenever depth
// couldn't be trusted. Pure: what the device daemon says, and all times, are passed in.
//
// The promise: a display whose picture is right only where it was woven for never shows depth that is older than 250 ms after the last
// good measurement, whatever has failed (the tracker, its line, the daemon, the link to it). It holds while a picture takes no more than
// 70 ms to draw.
#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "drivers/display/eyes.h"
#include "drivers/eye_tracker/filter.h"
#include "ipc/device_page.h"
#include "kiosk/stereo/lit_time.h"

namespace prismesh::kiosk::stereo {

/// The device daemon's page as last read; what couldn't be read, or isn't there, is empty.
struct DeviceReading {
  std::optional<ipc::EyesState> eyes;
  std::optional<ipc::PrismState> prism;
};

/// What kind of display follows the eyes, and where they are while nobody knows.
struct FollowOptions {
  bool follow = true;             ///< false: the eyes stay at `resting_mm`, in full depth
  bool mono_without_eyes = true;  ///< each eye's picture reaches it only where it is woven for; false: glasses sort the pictures out
  bool movable_mask = true;       ///< depth only while the mask follows
  Eigen::Vector3d resting_mm{0, 0, 650};
  std::optional<double> eye_separation_mm;  ///< measured with this viewer; empty: the tracker's
  bool operator==(const FollowOptions&) const = default;
};

/// Starting values, in one place.
struct FollowLimits {
  /// Since the last good measurement: mono by then. The rest of the 250 ms is for a refresh just missed, and for a picture that takes
  /// longer to draw than the last ones did.
  std::int64_t mono_after_ns = 210'000'000;
  std::int64_t lost_after_ns = 100'000'000;    ///< without a measurement for so long: the fade begins ...
  std::int64_t lost_soonest_ns = 60'000'000;   ///< ... sooner, down to this, where pictures take long
  std::int64_t fade_ns = 80'000'000;           ///< to mono when the mask stops following, and before it flies back
  std::int64_t rise_ns = 200'000'000;          ///< from mono to full depth
  std::int64_t mask_old_ns = 100'000'000;      ///< a mask state that is older says nothing
  std::int64_t rest_after_ns = 1'000'000'000;  ///< without a measurement for so long: slowly back to the resting place
  double place_slack_mm = 30;                  ///< no depth while the picture's eyes are farther than this from the real ones
  double mask_step_mm = 0.005;                 ///< a mask that moved less stands still: 0.02 pixels
};

/// What the picture uses.
struct SeenFrom {
  Eigen::Vector3d between_eyes_mm{0, 0, 650};
  Eigen::Vector3d toward_right = Eigen::Vector3d::UnitX();
  double eye_separation_mm = drivers::display::kMeanEyeSeparationMm;
  double depth_share = 1;         ///< 0: mono
  std::optional<double> mask_mm;  ///< empty: where it should be for these eyes
  bool operator==(const SeenFrom&) const = default;
};

class TrackedEyes {
 public:
  explicit TrackedEyes(const FollowOptions& options, const FollowLimits& limits = {});

  void set_options(const FollowOptions& options);
  const FollowOptions& options() const { return options_; }
  const FollowLimits& limits() const { return limits_; }
  /// To be asked about once a refresh, whether or not a picture is drawn then. Two equal answers: the picture may stay.
  SeenFrom look(const DeviceReading& reading, std::int64_t now_ns, const LitTime& lit);
  /// The last answer, in mono: that is what is shown, and depth rises from there.
  SeenFrom flatten();
  /// The newest good measurement; 0: none yet.
  std::int64_t measured_ns() const { return head_.time_ns; }

 private:
  /// Something in millimetres that follows a target, stands still within a zone, and never jumps when the target is another.
  class Glide {
   public:
    Glide(double across_mm, double deep_mm) : zone_(Eigen::Vector3d(across_mm, across_mm, deep_mm)) {}
    void begin(const Eigen::Vector3d& at);
    /// The target becomes another: what is shown stays, and goes over to it.
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
  std::int64_t slow_ns_ = 0;  ///< by so much older than usual are measurements when they come: a webcam's
  double eye_separation_mm_ = drivers::display::kMeanEyeSeparationMm;
  Source source_ = Source::resting;
  bool found_again_ = false;  ///< measurements have come back after they were lost
  Glide place_;
  Glide half_separation_;                      ///< from between the eyes to the right one
  std::optional<std::int64_t> disallowed_ns_;  ///< until_ns of the first picture since the mask stopped following
  std::optional<std::int64_t> looked_ns_;      ///< from_ns of the last look
  SeenFrom seen_;
};

}  // namespace prismesh::kiosk::stereo

#include "kiosk/stereo/tracked_eyes.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace prismesh::kiosk::stereo {

namespace {

using Eigen::Vector3d;

/// Radii of the zones in which the picture is constant. 2 mm to the side shift an eye's windows by 0.03 pixels.
constexpr double kStillAcrossMm = 2, kStillDeepMm = 6, kStillTurnMm = 0.5;
constexpr double kTakeUpSeconds = 0.06;  ///< time constants: to eyes that came back ...
constexpr double kLetGoSeconds = 0.4;    ///< ... and from lost eyes to the resting position
constexpr double kArrivedMm = 0.05;
constexpr std::int64_t kMaxLookDelayNs = 10'000'000;  ///< between two calls of look() while nothing is drawn
constexpr std::int64_t kClockSlackNs = 50'000'000;    ///< a measurement farther in the future is ignored
constexpr std::int64_t kMaxSlowNs = 500'000'000;      ///< max additional age of measurements

double seconds_of(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }
double part(std::int64_t of_ns, std::int64_t whole_ns) {
  return std::clamp(static_cast<double>(of_ns) / static_cast<double>(std::max<std::int64_t>(1, whole_ns)), 0.0, 1.0);
}

/// Whether the state is possible for a head in front of a screen. Anything else is a fault, even if the tracker reports that it tracks.
bool believable(const ipc::EyesState& eyes) {
  const Eigen::Map<const Vector3d> place(eyes.between_eyes_mm.data()), velocity(eyes.velocity_mm_s.data()), right(eyes.toward_right.data());
  return place.allFinite() && velocity.allFinite() && right.allFinite() && place.z() > 100 && place.norm() < 5000 &&
         velocity.norm() < 5000 && std::abs(right.norm() - 1) < 0.01 && eyes.eye_separation_mm >= 40 && eyes.eye_separation_mm <= 90;
}

}  // namespace

// --- gliding ---

void TrackedEyes::Glide::begin(const Vector3d& at) {
  zone_.reset();
  shown_ = zone_.follow(at);
  offset_.setZero();
  fresh_target_ = false;
}

Vector3d TrackedEyes::Glide::follow(const Vector3d& target, double seconds, double time_constant_s) {
  if (fresh_target_) zone_.reset();
  const Vector3d held = zone_.follow(target);
  if (fresh_target_) offset_ = shown_ - held;
  fresh_target_ = false;
  offset_ *= std::exp(-seconds / time_constant_s);
  if (offset_.norm() < kArrivedMm) offset_.setZero();
  return shown_ = held + offset_;
}

// --- looking ---

TrackedEyes::TrackedEyes(const FollowOptions& options, const FollowLimits& limits)
    : limits_(limits), place_(kStillAcrossMm, kStillDeepMm), half_separation_(kStillTurnMm, kStillTurnMm) {
  set_options(options);
}

void TrackedEyes::set_options(const FollowOptions& options) {
  options_ = options;
  if (options.eye_separation_mm) eye_separation_mm_ = *options.eye_separation_mm;
  looked_ns_.reset();
  source_ = Source::resting;
  place_.begin(options.resting_mm);
  half_separation_.begin(0.5 * eye_separation_mm_ * Vector3d::UnitX());
  seen_ = {};
  seen_.between_eyes_mm = options.resting_mm;
  seen_.eye_separation_mm = eye_separation_mm_;
  seen_.depth_share = options.follow && options.mono_without_eyes ? 0 : 1;
}

SeenFrom TrackedEyes::look(const DeviceReading& reading, std::int64_t now_ns, const LitTime& lit) {
  if (options_.movable_mask) follow_mask(reading, lit);
  if (!options_.follow) return seen_;
  take(reading, now_ns);
  move(now_ns, lit);
  if (options_.mono_without_eyes) {
    double max_share = share_for_eyes(now_ns, lit);
    max_share = std::min(max_share, 1 - std::min(1.0, place_.offset_mm() / limits_.place_slack_mm));
    if (options_.movable_mask) max_share = std::min(max_share, share_for_mask(reading, now_ns, lit));
    const double risen = seen_.depth_share + (looked_ns_ ? part(lit.from_ns - *looked_ns_, limits_.rise_ns) : 0);
    seen_.depth_share = std::clamp(max_share, 0.0, risen);
  }
  looked_ns_ = lit.from_ns;
  return seen_;
}

SeenFrom TrackedEyes::flatten() {
  SeenFrom flat = seen_;
  flat.depth_share = 0;
  if (options_.follow && options_.mono_without_eyes) seen_.depth_share = 0;
  return flat;
}

void TrackedEyes::take(const DeviceReading& reading, std::int64_t now_ns) {
  if (!reading.eyes) return;
  const ipc::EyesState& eyes = *reading.eyes;
  if (eyes.phase != ipc::EyesPhase::tracking || eyes.measured_ns <= head_.time_ns || eyes.measured_ns > now_ns + kClockSlackNs) return;
  if (!believable(eyes)) return;
  found_again_ = found_again_ || eyes.measured_ns - head_.time_ns > limits_.lost_after_ns;
  slow_ns_ = std::clamp(eyes.lost_after_ns, limits_.lost_after_ns, limits_.lost_after_ns + kMaxSlowNs) - limits_.lost_after_ns;
  head_ = eyes.head();
  if (!options_.eye_separation_mm) eye_separation_mm_ = eyes.eye_separation_mm;
}

void TrackedEyes::move(std::int64_t now_ns, const LitTime& lit) {
  const bool known = head_.time_ns != 0 && now_ns - head_.time_ns < limits_.rest_after_ns;
  const bool fresh = head_.time_ns != 0 && now_ns - heard_ns() < limits_.mono_after_ns;
  const Source source = fresh || (known && source_ == Source::tracked) ? Source::tracked : Source::resting;
  if (source != source_ || std::exchange(found_again_, false)) {
    place_.retarget();
    half_separation_.retarget();
    source_ = source;
  }
  // Lost eyes move on as long as the filter extrapolates, and are constant from then on.
  const bool tracked = source == Source::tracked;
  const double seconds = looked_ns_ ? std::max(0.0, seconds_of(lit.from_ns - *looked_ns_)) : 0;
  const double time_constant = tracked ? kTakeUpSeconds : kLetGoSeconds;
  seen_.between_eyes_mm = place_.follow(tracked ? predict(head_, lit.middle_ns()) : options_.resting_mm, seconds, time_constant);
  const Vector3d right = tracked ? head_.toward_right : Vector3d::UnitX();
  const Vector3d half = half_separation_.follow(0.5 * eye_separation_mm_ * right, seconds, time_constant);
  seen_.toward_right = half.normalized();
  seen_.eye_separation_mm = 2 * half.norm();
}

/// Full depth while measurements come; then a fade to mono, which the last picture before the deadline has reached.
double TrackedEyes::share_for_eyes(std::int64_t now_ns, const LitTime& lit) const {
  if (head_.time_ns == 0) return 0;
  const std::int64_t deadline = heard_ns() + limits_.mono_after_ns, ahead = lit.until_ns - now_ns;
  // A picture may have been begun just before the eyes are found lost: the next one must still be mono in time.
  const std::int64_t max_lost_after = limits_.mono_after_ns - ahead - kMaxLookDelayNs;
  const std::int64_t lost_after = std::clamp(max_lost_after, limits_.min_lost_after_ns, limits_.lost_after_ns);
  if (now_ns - heard_ns() <= lost_after) return 1;
  const std::int64_t fade_from = heard_ns() + lost_after + ahead;
  return part(deadline - lit.until_ns, deadline - fade_from);
}

double TrackedEyes::share_for_mask(const DeviceReading& reading, std::int64_t now_ns, const LitTime& lit) {
  const bool known = reading.prism && now_ns - reading.prism->time_ns < limits_.mask_old_ns;
  if (known && reading.prism->stereo_allowed) {
    disallowed_ns_.reset();
    const ipc::PrismState& mask = *reading.prism;
    const bool planned = mask.mono_from_ns != 0 || mask.mono_until_ns != 0;
    if (!planned || lit.from_ns >= mask.mono_until_ns) return 1;
    return part(mask.mono_from_ns - lit.until_ns, limits_.fade_ns);  // 0 for the last picture that would be seen during the move
  }
  if (!disallowed_ns_) disallowed_ns_ = lit.until_ns;
  // Before an announced move back the picture has already faded.
  if (known && lit.until_ns > reading.prism->mono_from_ns && lit.from_ns < reading.prism->mono_until_ns) return 0;
  return std::min(seen_.depth_share, 1 - part(lit.until_ns - *disallowed_ns_, limits_.fade_ns));
}

void TrackedEyes::follow_mask(const DeviceReading& reading, const LitTime& lit) {
  if (!reading.prism || reading.prism->measured_ns == 0) return;
  const double place = drivers::prism_servo::mask_position_at(*reading.prism, lit.middle_ns());
  if (!std::isfinite(place)) return;
  if (!seen_.mask_mm || std::abs(place - *seen_.mask_mm) > limits_.mask_step_mm) seen_.mask_mm = place;
}

}  // namespace prismesh::kiosk::stereo

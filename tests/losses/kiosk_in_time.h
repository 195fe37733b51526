// The kiosk's part of a station in virtual time: looks at the daemon's page once per refresh, takes a while to draw, and knows when each
// picture really lit up, on a display whose refreshes it can't see.
#pragma once

#include <cstdint>

#include "kiosk/stereo/lit_time.h"
#include "kiosk/stereo/tracked_eyes.h"

namespace prismesh::test {

class KioskInTime {
 public:
  /// `refresh_phase_ns`: of the display's refreshes against the clock.
  explicit KioskInTime(std::int64_t refresh_phase_ns) : refresh_phase_ns_(refresh_phase_ns) {}

  /// To be called every few milliseconds. `reading`: what the page says, empty without a daemon.
  void turn(const kiosk::stereo::DeviceReading& reading, std::int64_t now_ns) {
    if (handed_over_ns_ != 0 && now_ns >= handed_over_ns_) light_up(now_ns);
    if (handed_over_ns_ != 0 || now_ns < timing_.next_begin_ns()) return;
    timing_.begun(now_ns);
    const kiosk::stereo::SeenFrom next = eyes_.look(reading, now_ns, timing_.lit(now_ns));
    if (looked_ && next == seen_) return;
    looked_ = true;
    seen_ = next;
    handed_over_ns_ = now_ns + draw_ns;
  }

  /// The newest picture that was drawn is in full depth.
  bool in_depth() const { return seen_.depth_share >= 1; }
  bool mono() const { return looked_ && seen_.depth_share <= 0; }
  /// What was told to the daemon: from the moment on when nothing but mono is seen.
  bool seen_mono(std::int64_t now_ns) const { return !depth_shown_ && now_ns >= depth_until_ns_; }
  /// Until when depth was on the display; so far, while it is.
  std::int64_t depth_until_ns(std::int64_t now_ns) const { return depth_shown_ ? now_ns : depth_until_ns_; }

  std::int64_t draw_ns = 5'000'000;

 private:
  static constexpr std::int64_t kPeriodNs = 16'000'000, kPanelNs = 10'000'000;

  void light_up(std::int64_t now_ns) {
    timing_.drawn(now_ns);
    handed_over_ns_ = 0;
    const std::int64_t refresh = ((now_ns - refresh_phase_ns_) / kPeriodNs + 1) * kPeriodNs + refresh_phase_ns_;
    const std::int64_t lit = refresh + kPeriodNs / 2 + kPanelNs;
    if (depth_shown_ && seen_.depth_share <= 0) depth_until_ns_ = lit;
    depth_shown_ = seen_.depth_share > 0;
  }

  kiosk::stereo::TrackedEyes eyes_{kiosk::stereo::FollowOptions{}};
  kiosk::stereo::PictureTiming timing_{{kPeriodNs, kPanelNs}};
  kiosk::stereo::SeenFrom seen_;
  std::int64_t refresh_phase_ns_;
  std::int64_t handed_over_ns_ = 0;
  bool looked_ = false;
  bool depth_shown_ = false;
  std::int64_t depth_until_ns_ = 0;
};

}  // namespace prismesh::test

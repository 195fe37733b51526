// Follows the eyes: turns the device daemon's readings into the eyes that the next picture is drawn for, and tells daemon and user what is
// shown.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "base/clock.h"
#include "kiosk/device_link.h"
#include "kiosk/notices/trace.h"
#include "kiosk/stereo/lit_time.h"
#include "kiosk/stereo/tracked_eyes.h"
#include "kiosk/toolkit/eyes_facts.h"

namespace prismesh::kiosk {

class EyeWatch {
 public:
  EyeWatch(const stereo::FollowOptions& options, DeviceLink& link, Clock& clock, notices::Trace trace);

  /// Sets another display profile, or fixed eyes.
  void set_options(const stereo::FollowOptions& options);
  void set_timing(const stereo::DisplayTiming& timing) { timing_.set_timing(timing); }
  /// Forbids depth, with the reason as a sentence; empty: allows it.
  void refuse_depth(std::string why) { refused_ = std::move(why); }
  bool follows() const { return eyes_.options().follow; }
  /// The eyes may move without any event.
  bool watches() const { return follows() || (eyes_.options().movable_mask && link_.connected()); }

  /// Reads where the eyes are, once per refresh of the display. True: the picture must be drawn again.
  bool look();
  /// What the next picture is drawn for.
  const stereo::SeenFrom& seen() const { return seen_; }
  /// The time to look, or to begin the next picture.
  std::int64_t next_look_ns() const { return timing_.next_begin_ns(); }

  /// The picture for `seen` is drawn to its last pixel and about to be shown. `refresh_ns`: when the display refreshed last, if it tells.
  void drawn(std::optional<std::int64_t> refresh_ns);

  /// The picture for `seen` was taken for a file: as if a display had shown it, however long drawing took.
  void taken();
  /// When the picture for `seen` is expected to light up.
  std::int64_t lit_ns() const { return lit_.from_ns; }

  /// The facts for the panel; nothing while no eyes are followed.
  std::optional<toolkit::EyesFacts> facts() const { return facts_; }

 private:
  void note_shown(std::int64_t lit_ns);
  void tell(std::int64_t now_ns);
  void trace_phase(const stereo::DeviceReading& reading, std::int64_t now_ns);
  std::optional<toolkit::EyesFacts> word(const stereo::DeviceReading& reading) const;

  DeviceLink& link_;
  Clock& clock_;
  notices::Trace trace_;
  stereo::TrackedEyes eyes_;
  stereo::PictureTiming timing_{{}};
  stereo::LitTime lit_;
  std::string refused_;
  stereo::SeenFrom seen_;
  std::optional<stereo::SeenFrom> shown_;    ///< what the picture on the display was drawn for
  std::optional<std::int64_t> mono_lit_ns_;  ///< from when on nothing but mono is seen; to be told to the daemon then
  std::optional<toolkit::EyesFacts> facts_;
  std::optional<ipc::EyesPhase> traced_phase_;
  std::optional<bool> traced_mono_;
};

}  // namespace prismesh::kiosk

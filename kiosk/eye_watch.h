// Who looks at the picture, and from where: the device daemon's word, made into what the next picture is drawn for, and told back to the
// daemon and the user.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "base/clock.h"
#include "kiosk/device_link.h"
#include "kiosk/panels/panel_facts.h"
#include "kiosk/stereo/lit_time.h"
#include "kiosk/stereo/tracked_eyes.h"
#include "kiosk/trace.h"

namespace prismesh::kiosk {

class EyeWatch {
 public:
  EyeWatch(const stereo::FollowOptions& options, DeviceLink& link, Clock& clock, Trace trace);

  /// Another display profile, or fixed eyes.
  void set_options(const stereo::FollowOptions& options);
  void set_timing(const stereo::DisplayTiming& timing) { timing_.set_timing(timing); }
  /// Why nothing may be shown in depth here, a sentence; empty: it may.
  void refuse_depth(std::string why) { refused_ = std::move(why); }
  bool follows() const { return eyes_.options().follow; }
  /// What it sees may change by itself.
  bool watches() const { return follows() || (eyes_.options().movable_mask && link_.connected()); }

  /// A beat of the display has come: looks where the eyes are. True: what is on the display must be drawn again.
  bool look();
  /// What the next picture is drawn for.
  const stereo::SeenFrom& seen() const { return seen_; }
  /// When it is time to look, or to begin the next picture.
  std::int64_t next_look_ns() const { return timing_.next_begin_ns(); }

  /// The picture for `seen` is drawn to its last pixel and about to be shown. `refresh_ns`: when the display refreshed last, if it tells.
  void drawn(std::optional<std::int64_t> refresh_ns);

  /// The picture for `seen` was taken for a file: as if a display had shown it, however long drawing took.
  void taken();
  /// When the picture for `seen` is expected to light up.
  std::int64_t lit_ns() const { return lit_.from_ns; }

  /// What stands in the panel; nothing while no eyes are followed.
  std::optional<panels::EyesFacts> facts() const { return facts_; }

 private:
  void note_shown(std::int64_t lit_ns);
  void tell(std::int64_t now_ns);
  void trace_phase(const stereo::DeviceReading& reading, std::int64_t now_ns);
  std::optional<panels::EyesFacts> word(const stereo::DeviceReading& reading) const;

  DeviceLink& link_;
  Clock& clock_;
  Trace trace_;
  stereo::TrackedEyes eyes_;
  stereo::PictureTiming timing_{{}};
  stereo::LitTime lit_;
  std::string refused_;
  stereo::SeenFrom seen_;
  std::optional<stereo::SeenFrom> shown_;    ///< what the picture on the display was drawn for
  std::optional<std::int64_t> mono_lit_ns_;  ///< from when on nothing but mono is seen; to be told to the daemon then
  std::optional<panels::EyesFacts> facts_;
  std::optional<ipc::EyesPhase> traced_phase_;
  std::optional<bool> traced_mono_;
};

}  // namespace prismesh::kiosk

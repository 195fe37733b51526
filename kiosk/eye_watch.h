// Who looks at the picture, and from where: the device daemon's word, made into what the next picture is drawn for, and told back to the
// daemon and the user.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/clock.h"
#include "kiosk/device_link.h"
#include "kiosk/panels/panels.h"
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
  bool follows() const { return eyes_.options().follow; }

  /// A beat of the display has come: looks where the eyes are. True: what is on the display must be drawn again.
  bool look();
  /// What the next picture is drawn for.
  const stereo::SeenFrom& seen() const { return seen_; }
  /// When it is time to look, or to begin the next picture.
  std::int64_t next_look_ns() const { return timing_.next_begin_ns(); }

  /// The picture for `seen` is drawn to its last pixel and about to be shown. `refresh_ns`: when the display refreshed last, if it tells.
  void drawn(std::optional<std::int64_t> refresh_ns);

  /// What stands in the panel; nothing while no eyes are followed.
  std::optional<panels::EyesFacts> facts() const { return facts_; }

 private:
  void tell(std::int64_t now_ns);
  void trace_phase(const stereo::DeviceReading& reading, std::int64_t now_ns);
  std::optional<panels::EyesFacts> word(const stereo::DeviceReading& reading) const;

  DeviceLink& link_;
  Clock& clock_;
  Trace trace_;
  stereo::TrackedEyes eyes_;
  stereo::PictureTiming timing_{{}};
  stereo::SeenFrom seen_;
  std::optional<stereo::SeenFrom> shown_;    ///< what the picture on the display was drawn for
  std::optional<std::int64_t> mono_lit_ns_;  ///< from when on nothing but mono is seen; to be told to the daemon then
  std::optional<panels::EyesFacts> facts_;
  std::optional<ipc::EyesPhase> traced_phase_;
  std::optional<bool> traced_mono_;
};

}  // namespace prismesh::kiosk

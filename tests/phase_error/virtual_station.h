// A whole station in virtual time, from the head to the light: a head that moves, the tracker's bytes on a serial line, deviced's loop,
// the servo's bytes and its mask, the state page, the kiosk's eyes at its display's refresh. Nothing in it is faster or more exact than
// the real thing would be: bytes take their time, pictures take theirs, the mask lags.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include <Eigen/Core>

#include "drivers/display/profile.h"
#include "drivers/eye_tracker/simulated_head.h"
#include "kiosk/stereo/tracked_eyes.h"

namespace prismesh::phase_error {

/// A built-in profile on a panel of 1280 columns.
drivers::display::Profile on_panel(const std::string& profile);

struct StationSettings {
  drivers::eye_tracker::HeadSource head;
  /// False: what was measured last counts for now, for the mask and for the picture: no filter, no extrapolation.
  bool predicts = true;
  drivers::display::Profile profile = on_panel("prism-mask");
  double noise_mm = 1;
  std::uint64_t seed = 1;
  double tracker_latency_s = 0.02;           ///< from the head being there to its record's last byte
  std::int64_t line_latency_ns = 1'000'000;  ///< of the serial adapters, on top of the bytes' own time
  std::int64_t draw_ns = 8'000'000;          ///< what the kiosk takes for a picture
};

/// What is there to be seen at a moment.
struct Moment {
  std::int64_t time_ns = 0;       ///< since the station's begin
  Eigen::Vector3d head_mm;        ///< truly
  double mask_mm = 0;             ///< truly
  kiosk::stereo::SeenFrom drawn;  ///< what the picture that is lit was drawn for
};

/// Runs the station for so long and tells `see` what is seen, twice a picture. The first two seconds aren't told: devices are found then.
void run(const StationSettings& settings, double seconds, const std::function<void(const Moment&)>& see);

}  // namespace prismesh::phase_error

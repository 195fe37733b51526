// A complete station in virtual time, from the head to the light: a moving head, the tracker's bytes on a serial line, deviced's loop, the
// servo's bytes and its mask, the state page, and the kiosk's eyes at its display's refresh. All delays are modelled: transmission of
// bytes, drawing and display of pictures, lag of the mask.
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

struct VirtualStationSettings {
  drivers::eye_tracker::HeadSource head;
  /// False: without filter and extrapolation; mask and picture use the last measurement.
  bool predicts = true;
  drivers::display::Profile profile = on_panel("prism-mask");
  double noise_mm = 1;
  std::uint64_t seed = 1;
  double tracker_latency_s = 0.02;           ///< from the head's position to its record's last byte
  std::int64_t line_latency_ns = 1'000'000;  ///< of the serial adapters, added to the transmission time
  std::int64_t draw_ns = 8'000'000;          ///< the kiosk's time for a picture
};

/// What is visible at a moment.
struct Moment {
  std::int64_t time_ns = 0;       ///< since the start of the station
  Eigen::Vector3d head_mm;        ///< true position
  double mask_mm = 0;             ///< true position
  kiosk::stereo::SeenFrom drawn;  ///< the eyes for which the lit picture was drawn
};

/// Runs the station for so long and passes what is visible to `see`, twice per picture. Skips the first two seconds, in which the devices
/// are found.
void run(const VirtualStationSettings& settings, double seconds, const std::function<void(const Moment&)>& see);

}  // namespace prismesh::phase_error

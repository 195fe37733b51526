// Heads that move from side to side before a virtual station, and the figures of the seen picture.
#pragma once

#include <vector>

#include "tests/phase_error/phase.h"
#include "tests/phase_error/virtual_station.h"

namespace prismesh::phase_error {

/// Back and forth without a pause: a sine, so that most of the time is near the peak speed and all accelerations occur.
struct Sweep {
  double peak_mm_s = 250;  ///< 0: the head stands still, 40 mm from the middle
  double reach_mm = 80;    ///< to either side
  double distance_mm = 650;
};
drivers::eye_tracker::HeadSource to_and_fro(const Sweep& sweep);

struct Figures {
  std::vector<double> moved, middle, panel;  ///< values of Phase at each moment in stereo
  std::vector<double> head_mm;               ///< distance across the screen between the head's true position and the one drawn for
  std::size_t moments = 0;                   ///< in stereo or not
  double stereo_share() const { return static_cast<double>(middle.size()) / static_cast<double>(moments); }
};
/// Figures of all seeds together, `seconds` each.
Figures figures_of(VirtualStationSettings settings, int seeds, double seconds = 22);

/// The value that a share of the values doesn't exceed.
double quantile(std::vector<double> values, double share);

}  // namespace prismesh::phase_error

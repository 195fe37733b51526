// The distance between the drawn and the seen picture, in pixels of the panel.
#pragma once

#include <vector>

#include "drivers/display/profile.h"
#include "tests/phase_error/virtual_station.h"

namespace prismesh::phase_error {

/// Phase errors at one moment, over all windows of both eyes along the panel's middle row. Only stereo pictures have phase errors.
struct Phase {
  /// Motion of the windows since the picture was drawn for them, which prediction should reduce. Mean magnitude over the panel's width, of
  /// the worse eye.
  double moved_pixels = 0;
  /// Distance from a window's middle to the middle of the eye's own stripes (traced by the viewer simulation); includes optics and the
  /// width of the stripes. For the window at the screen's middle, and the 99th percentile over the panel.
  double middle_pixels = 0;
  double panel_pixels = 0;
  double wrong_share = 0;  ///< mean share of the other eye's light in what an eye sees
};
Phase phase_of(const Moment& moment, const drivers::display::Profile& profile);

}  // namespace prismesh::phase_error

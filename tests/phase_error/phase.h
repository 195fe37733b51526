// How far what is drawn is from what is seen, in pixels of the panel.
#pragma once

#include <vector>

#include "drivers/display/profile.h"
#include "tests/phase_error/virtual_station.h"

namespace prismesh::phase_error {

/// At a moment, over all windows of both eyes along the panel's middle row. Only what is in stereo has phase errors.
struct Phase {
  /// By which the windows have moved since the picture was drawn for them: what prediction is there for. Mean over the panel's width of
  /// the worse eye, without sign.
  double moved_pixels = 0;
  /// From the middle of a window to the middle of the stripes that are the eye's own (traced by the viewer simulation): all there is,
  /// optics and the width of the stripes included. The window at the screen's middle and the 99th percentile over the panel.
  double middle_pixels = 0;
  double panel_pixels = 0;
  double wrong_share = 0;  ///< of what an eye sees, how much is the other's, on average
};
Phase phase_of(const Moment& moment, const drivers::display::Profile& profile);

}  // namespace prismesh::phase_error

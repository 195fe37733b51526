// Computes the head positions from which each eye sees its own picture on the whole panel, for a mask display and a way of composing
// pictures.
#pragma once

#include <optional>

#include "drivers/display/phase_map.h"

namespace prismesh::drivers::display {

enum class Composing : unsigned char {
  fixed_columns,  ///< alternate columns never change; only the mask follows the head
  pixels,         ///< each pixel shows the eye with the nearest window
  subpixels,      ///< each third of a pixel shows the eye with the nearest window
};

/// A mask display and how pictures are composed for it.
struct MaskDisplay {
  MaskOptics optics{};  ///< `panel_columns` is taken from `panel`
  PanelArea panel{};
  Composing composing = Composing::subpixels;
  double eye_separation_mm = kMeanEyeSeparationMm;  ///< of the viewer
};

/// Returns the worst phase error of both eyes' windows on the panel, in pixels: half a pixel minus the distance from a window's middle to
/// the nearest light of another window. For a pixel that shows one window this is the pixel's distance from the window's middle. At 0.5 an
/// eye sees the border between its own light and another's, above 0.5 the wrong light. A window without light counts as 1. The mask is at
/// its ideal position (mask_position_mm). `head_mm`: the point between the eyes, from the panel's centre.
double worst_phase_error(const MaskDisplay& display, const Eigen::Vector3d& head_mm);

/// Min. and max. distance around the design distance at which the worst phase error is within `limit_px`, in steps of 1 mm, up to 2000 mm.
/// Empty if the error exceeds the limit at the design distance.
struct DepthSpan {
  double min_mm = 0, max_mm = 0;
};
std::optional<DepthSpan> working_depths(const MaskDisplay& display, double head_x_mm, double limit_px);

}  // namespace prismesh::drivers::display

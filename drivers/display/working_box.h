// Where a head may be so that each eye sees its own picture all over the panel: what a mask, and a way of composing for it, can do.
#pragma once

#include <optional>

#include "drivers/display/phase_map.h"

namespace prismesh::drivers::display {

enum class Composing : unsigned char {
  fixed_columns,  ///< alternate columns never change, the mask's shift alone follows the head
  pixels,         ///< each pixel shows the eye whose window it is nearest to
  subpixels,      ///< each third of a pixel does
};

/// Worst phase error of both eyes' windows over the panel, in pixels: by how much the light nearest to a window's middle that isn't the
/// window's own comes nearer than half a pixel. For a pixel that shows one window that is its distance from the window's middle; at 0.5
/// an eye looks at the border between its own light and another's, beyond it at the wrong light; a window that got no light counts as 1.
/// The mask stands where the law for its shift puts it. `head_mm`: between the eyes, from the panel's centre.
double worst_phase_error(const MaskOptics& optics, const Eigen::Vector3d& head_mm, double separation_mm, const PanelArea& panel,
                         Composing composing);

/// Nearest and farthest distance around the design distance at which the worst phase error stays within `limit` pixels, to 1 mm, 2000 mm
/// at most; empty if it doesn't even there.
struct DepthSpan {
  double nearest_mm = 0, farthest_mm = 0;
};
std::optional<DepthSpan> working_depths(const MaskOptics& optics, double head_x_mm, double separation_mm, const PanelArea& panel,
                                        Composing composing, double limit);

}  // namespace prismesh::drivers::display

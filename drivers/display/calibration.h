// Fits a display's optics to a viewer's choices: the mask's zero, and the gap between mask and panel. Pure functions.
#pragma once

#include <span>

#include <Eigen/Core>

#include "base/error.h"
#include "drivers/display/optics.h"

namespace prismesh::drivers::display {

/// A viewer's choice: the mask position at which, from this head position, each eye sees its own picture best.
struct MaskChoice {
  Eigen::Vector3d between_eyes_mm = Eigen::Vector3d::Zero();
  double mask_mm = 0;  ///< the mask position that the servo reported; positions that differ by a mask pitch are equivalent
};

struct MaskFit {
  double zero_mm = 0;      ///< for MaskOptics::zero_mm, within half a mask pitch
  double gap_scale = 1;    ///< for MaskOptics::gap_scale
  bool gap_found = false;  ///< the head positions were far enough apart to determine the gap; otherwise gap_scale is unchanged
  double scatter_mm = 0;   ///< root mean square of the choices' residuals, as mask travel
  double scatter_px = 0;   ///< the same in pixels on the panel
  std::size_t worst = 0;   ///< index of the choice with the max. residual, and that residual
  double worst_px = 0;
};

inline constexpr double kMinGapScale = 0.85, kMaxGapScale = 1.15;
/// A larger scatter means that a choice is wrong or that the viewer has moved.
inline constexpr double kMaxScatterPx = 0.2;

/// Fits the zero to the choices, and the gap if the head positions allow it; takes all other values from `optics`. Errors, as sentences for
/// the viewer: no choice; a choice that isn't finite or has the head behind the screen; choices that contradict each other (names the worst
/// one by its number, from 1).
Result<MaskFit> fit_mask(const MaskOptics& optics, std::span<const MaskChoice> choices);

}  // namespace prismesh::drivers::display

// From what a viewer chose to a display's optics: where the mask really stands, and how far it really is from the panel. Pure.
#pragma once

#include <span>

#include <Eigen/Core>

#include "base/error.h"
#include "drivers/display/optics.h"

namespace prismesh::drivers::display {

/// "Here each of my eyes sees its own picture best."
struct MaskChoice {
  Eigen::Vector3d between_eyes_mm = Eigen::Vector3d::Zero();
  double mask_mm = 0;  ///< where the servo said the mask stood; equivalent to any place a whole mask pitch away
};

struct MaskFit {
  double zero_mm = 0;      ///< for MaskOptics::zero_mm, within half a mask pitch
  double gap_scale = 1;    ///< for MaskOptics::gap_scale
  bool gap_found = false;  ///< the heads were far enough apart to tell; otherwise gap_scale is what it was
  double scatter_mm = 0;   ///< root mean square of what the choices miss the fit by, mask travel
  double scatter_px = 0;   ///< the same as pixels on the panel
  std::size_t worst = 0;   ///< the choice that misses it most, and by how much
  double worst_px = 0;
};

inline constexpr double kGapScaleLow = 0.85, kGapScaleHigh = 1.15;
/// More than this and somebody chose the wrong place, or moved: better choose again.
inline constexpr double kScatterTooLargePx = 0.2;

/// Fits the zero, and the gap where the heads' places allow, to choices; `optics` gives all the rest. Errors, as sentences for the
/// viewer: no choice, one that isn't a number or has the head behind the screen, choices that contradict each other (the worst is named by
/// its number, from 1).
Result<MaskFit> fit_mask(const MaskOptics& optics, std::span<const MaskChoice> choices);

}  // namespace prismesh::drivers::display

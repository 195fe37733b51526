// The optics of a display whose panel lies behind a mask of parallel elements (prisms, lenses or slits): which place of the panel an
// eye sees through which element. Pure geometry. Millimetres on the panel, from its centre, x to the right, y up.
//
// Element k of the mask stands at m = k * mask_pitch + mask_mm + zero + r. An eye at (x, y, D) sees through it the panel at
// u = m + (m - x) * g' / D, where g' is the air-equivalent gap: the *window* k of that eye. An eye's windows are g'-magnified images of
// the mask, so they lie at (nearly) even distances; they are 2 pixels apart only at the design distance. Elements may lean against
// the panel's columns: then all of this holds for u - lean * v at height v, and x - lean * y.
//
// Which column is whose: with mask_mm and zero at 0 and the head at (0, 0, design distance), the left eye has the even columns (0, 2, ..)
// whatever the panel's width. So the mask's own reference r depends on the number of columns (`panel_columns`): it puts the boundary
// between an eye's windows onto the left edge of the even column nearest the middle. Only places on the panel depend on it, not where
// the mask should go: who only moves the mask can leave panel_columns at 0.
//
// Source: the 2004 paper's section 5.1 for the arrangement; the relations follow from similar triangles, the exact ones from Snell's law.
#pragma once

#include <Eigen/Core>

#include "drivers/display/eyes.h"

namespace prismesh::drivers::display {

struct MaskOptics {
  double pixel_pitch_mm = 0.2805;
  double design_distance_mm = 650;
  double design_separation_mm = kMeanEyeSeparationMm;
  double refractive_index = 1.52;  ///< of what lies between panel and mask; 1: air
  double lean = 0;                 ///< dx/dy of the elements against the panel's columns; 0 for a prism mask
  double zero_mm = 0;              ///< calibrated: where the mask really stands when its servo says 0
  double pitch_scale = 1;          ///< calibrated: real mask pitch over the computed one
  double gap_scale = 1;            ///< calibrated: real gap over the computed one
  int panel_columns = 0;           ///< of the whole panel, pixels: see above; 0: a multiple of four
  bool operator==(const MaskOptics&) const = default;

  /// g' = p * D0 / e, times gap_scale.
  double air_gap_mm() const;
  /// P = 2p * D0 / (D0 + g'), times pitch_scale; g' as designed (the two scales are independent of each other).
  double mask_pitch_mm() const;
  /// The panel's place that the zero refers to: the left edge of the even column nearest the middle; at most a pixel from the centre.
  double reference_mm() const;
};

/// The mask position at which the elements' windows fall onto an observer's own pixels at the screen's middle: s = x * g' / (D + g') -
/// zero, not reduced modulo the pitch. `between_mm`: between the eyes (a leaning mask also follows y).
double mask_position_mm(const MaskOptics& optics, const Eigen::Vector3d& between_mm);

/// Number (with fraction) of the element through which `eye` sees the place u of the panel, at height v: an integer in the middle of a
/// window. Exact (Snell) where refractive_index > 1, skew rays included. `mask_mm`: where the servo says the mask stands. Finite for any
/// finite input: an eye nearer than 20 mm is taken to be there, one farther than 100 m aside likewise.
double window_number(const MaskOptics& optics, const Eigen::Vector3d& eye_mm, double mask_mm, double u_mm, double v_mm);

/// The even spacing that fits an eye's windows best (least squares) across a panel of this width: window k (an integer) is centred at
/// first_mm + k * spacing_mm at height v = 0, and lean * v to the right of that at height v.
struct WindowRow {
  double first_mm = 0;
  double spacing_mm = 1;
};
WindowRow window_row(const MaskOptics& optics, const Eigen::Vector3d& eye_mm, double mask_mm, double panel_width_mm);

}  // namespace prismesh::drivers::display

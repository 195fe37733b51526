// The optics of a display whose panel lies behind a mask of parallel elements (prisms, lenses or slits): computes which position of the
// panel an eye sees through which element. Pure geometry. Millimetres on the panel, from its centre, x to the right, y up.
//
// Element k of the mask is at m = k * mask_pitch + mask_mm + zero + r. An eye at (x, y, D) sees through it the panel position u = m + (m -
// x) * g' / D, the *window* k of that eye; g' is the air-equivalent gap. An eye's windows are images of the mask, magnified by g', so their
// spacing is (nearly) even; it is 2 pixels only at the design distance. If the elements lean against the panel's columns, all of this holds
// for u - lean * v at height v, and for x - lean * y.
//
// Assignment of columns: with mask_mm and zero at 0 and the head at (0, 0, design distance), the left eye has the even columns (0, 2, ..),
// whatever the panel's width. The mask's reference r therefore depends on the number of columns (`panel_columns`): it puts the boundary
// between an eye's windows on the left edge of the even column nearest the middle. Only positions on the panel depend on it, not the mask's
// target position: code that only moves the mask can leave panel_columns at 0.
//
// Source: section 5.1 of the 2004 paper for the arrangement; the relations follow from similar triangles, the exact ones from Snell's law.
#pragma once

#include <Eigen/Core>

#include "drivers/display/eyes.h"

namespace prismesh::drivers::display {

struct MaskOptics {
  double pixel_pitch_mm = 0.2805;
  double design_distance_mm = 650;
  double design_separation_mm = kMeanEyeSeparationMm;
  double refractive_index = 1.52;  ///< of the material between panel and mask; 1: air
  double lean = 0;                 ///< dx/dy of the elements against the panel's columns; 0 for a prism mask
  double zero_mm = 0;              ///< calibrated: actual mask position when the servo reports 0
  double pitch_scale = 1;          ///< calibrated: actual mask pitch divided by the computed one
  double gap_scale = 1;            ///< calibrated: actual gap divided by the computed one
  int panel_columns = 0;           ///< of the whole panel, see above; 0: a multiple of four
  bool operator==(const MaskOptics&) const = default;

  /// Returns g' = p * D0 / e, times gap_scale.
  double air_gap_mm() const;
  /// Returns P = 2p * D0 / (D0 + g'), times pitch_scale. Uses the designed g', so that the two scales are independent.
  double mask_pitch_mm() const;
  /// Returns the panel position that the zero refers to: the left edge of the even column nearest the middle, max. one pixel from the
  /// centre.
  double reference_mm() const;
};

/// Returns the mask position at which the elements' windows coincide with an observer's own pixels in the middle of the screen: s = x * g'
/// / (D + g') - zero, not reduced modulo the pitch. `between_mm`: the point between the eyes (for a leaning mask, y counts too).
double mask_position_mm(const MaskOptics& optics, const Eigen::Vector3d& between_mm);

/// Returns the number (with fraction) of the element through which `eye` sees the panel position u at height v; it is an integer in the
/// middle of a window. Exact (Snell's law, skew rays included) for refractive_index > 1. `mask_mm`: the mask position that the servo
/// reports. The result is finite for any finite input: eye coordinates are limited to a min. distance of 20 mm and to 100 m.
double window_number(const MaskOptics& optics, const Eigen::Vector3d& eye_mm, double mask_mm, double u_mm, double v_mm);

/// The even spacing that fits an eye's windows best (least squares) across a panel of this width. The centre of window k (an integer) is at
/// first_mm + k * spacing_mm at height v = 0, and lean * v to the right of that at height v.
struct WindowRow {
  double first_mm = 0;
  double spacing_mm = 1;
};
WindowRow window_row(const MaskOptics& optics, const Eigen::Vector3d& eye_mm, double mask_mm, double panel_width_mm);

}  // namespace prismesh::drivers::display

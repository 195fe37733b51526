// Traces rays through a display whose panel is behind a glass with a mask of parallel elements on its front. Independent of how pictures
// are woven for it.
//
// Millimetres; the origin is the middle of the mask, x to the right, y up, z toward the viewer. The panel is at z = -glass. Positions on
// the panel are (u, v), parallel to x and y, from the panel's middle.
//
// Source: similar triangles and Snell's law. Pitch and gap follow from two conditions at the design distance: an eye's rays through
// neighbouring elements meet the panel two pixels apart, and the two eyes' rays through one element meet it one pixel apart.
#pragma once

#include "base/error.h"

namespace prismesh::viewer {

struct Point {
  double x = 0, y = 0, z = 0;
};

struct Eyes {
  Point left, right;
};
/// `toward_right`: from the left eye to the right one; any length.
Eyes eyes_around(const Point& between, double separation_mm = 63, const Point& toward_right = {1, 0, 0});

enum class Stripes : unsigned char {
  rgb,   ///< a pixel is three stripes, red leftmost
  bgr,   ///< blue leftmost
  none,  ///< the whole pixel shines in all colours
};

struct Panel {
  int columns = 1280;
  int rows = 1024;
  double pitch_mm = 0.2805;
  Stripes stripes = Stripes::rgb;
  double black_share = 0;  ///< dark share of a stripe's width, at its borders

  double width_mm() const { return columns * pitch_mm; }
  double height_mm() const { return rows * pitch_mm; }
  /// Height v of a row's middle; row 0 is at the top.
  double row_height_mm(int row) const { return (0.5 * rows - row - 0.5) * pitch_mm; }
};

struct MaskDisplay {
  Panel panel;
  double design_distance_mm = 650;  ///< from the mask
  double design_separation_mm = 63;
  double index = 1.52;     ///< of the glass; 1: air
  double lean = 0;         ///< dx/dy of the elements
  double offset_mm = 0;    ///< the mask's true position minus the one that the servo reports
  double pitch_scale = 1;  ///< true pitch divided by the designed one
  double glass_scale = 1;  ///< true thickness divided by the designed one

  double air_gap_mm() const;  ///< thickness of an air gap that is equivalent to the glass near the axis
  double glass_mm() const;
  double element_pitch_mm() const;
  /// Position of element 0 with the servo at 0: where an observer in the middle at the design distance sees the left edge of the even
  /// column nearest to the panel's middle, so that the even columns belong to the left eye.
  double reference_mm() const;
  /// x of an element's axis at height y of the mask. `element` may be between two.
  double element_x_mm(double element, double mask_mm, double y_mm) const;
  /// The mask position for an observer there, near the panel's middle; not reduced modulo the pitch.
  double ideal_mask_mm(const Point& between) const;
  /// Errors: an impossible value, by its name.
  Result<void> check() const;
};

/// Where a ray from the eye through the mask's point (x, y, 0) meets the panel: refracted once, at the glass's front.
struct PanelPlace {
  double u_mm = 0, v_mm = 0;
};
PanelPlace seen_through(const MaskDisplay& display, const Point& eye, double x_mm, double y_mm);

/// What an eye sees at height v of the panel through an element.
struct Window {
  double u_mm = 0;            ///< on the panel
  double x_mm = 0, y_mm = 0;  ///< the point of the mask through which it shines
};
Window window_of(const MaskDisplay& display, const Point& eye, double mask_mm, double element, double v_mm);

/// The element (with fraction) whose window is at the position (u, v).
double element_at(const MaskDisplay& display, const Point& eye, double mask_mm, double u_mm, double v_mm);

/// The apparent point in space when each eye sees it in the direction of its point of the mask: where the two rays come closest.
Point triangulated(const Eyes& eyes, const Window& left, const Window& right);

}  // namespace prismesh::viewer

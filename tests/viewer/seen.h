// What an eye sees on a mask display: one colour per element of the mask and row of the panel.
#pragma once

#include <vector>

#include "tests/viewer/light.h"
#include "tests/viewer/mask_display.h"

namespace prismesh::viewer {

struct Sharpness {
  double window_pixels = 1;  ///< width of the part of a row that is seen through an element
  double leak = 0;           ///< light from positions half a period away, relative to the window's: crosstalk
};

/// Rows from the top. Omits elements whose windows aren't completely on the panel in every row.
struct Seen {
  int first_element = 0;
  int elements = 0;
  int rows = 0;
  double window_mm = 0;         ///< width of each window
  std::vector<float> place_mm;  ///< on the panel, [row][element]: ascending within a row
  std::vector<Colour> light;    ///< [row][element]

  std::size_t index(int element, int row) const { return static_cast<std::size_t>(row) * elements + element; }
  const Colour& at(int element, int row) const { return light[index(element, row)]; }
  /// As a picture, one pixel per element and row.
  LightImage image() const;
};

/// An eye at its position: the rays are traced once, for any number of pictures.
class Viewpoint {
 public:
  /// Traces every element and row. Errors: an eye that isn't before the mask; an impossible display or window.
  static Result<Viewpoint> at(const MaskDisplay& display, const Point& eye, double mask_mm, const Sharpness& sharpness = {});
  /// `picture`: what the panel shows. Errors: not of the panel's size.
  Result<Seen> look(const LightImage& picture) const;

 private:
  Panel panel_;
  Sharpness sharpness_;
  double period_pixels_ = 2;  ///< between neighbouring windows
  Seen places_;               ///< dark
};

/// For a single picture.
Result<Seen> look(const MaskDisplay& display, const LightImage& picture, const Point& eye, double mask_mm, const Sharpness& sharpness = {});

/// What would be seen at the same positions of an ordinary screen that shows `picture`, each one period wide, as the reference for one
/// element. Of the same panel.
Seen ordinary(const MaskDisplay& display, const LightImage& picture, const Seen& places);

/// Interpolates linearly between elements to a common grid of the whole panel, `columns` wide; positions beyond the outermost elements take
/// their values.
LightImage on_grid(const MaskDisplay& display, const Seen& seen, int columns);

/// Mean absolute difference in levels (0..255), over all elements, rows and colours. Sizes must agree.
double mean_difference(const Seen& a, const Seen& b);
double mean_difference(const LightImage& a, const LightImage& b);

/// Share of another picture in what is seen: b of the least squares seen = a * own + b * other + constant, over differences along rows, so
/// that common shading doesn't count. 0 if the pictures are the same.
double share_of_other(const Seen& seen, const Seen& own, const Seen& other);

/// Centre of the connected piece that differs most from `ground` (a ghost at the other eye's position is another piece), weighted by the
/// difference: element and row with fractions. `light` is 0 if nothing differs.
struct Spot {
  double element = 0;  ///< the mask's number
  double row = 0;      ///< 0.5: the middle of the uppermost row
  double light = 0;    ///< sum of differences
};
Spot spot_in(const Seen& seen, const Seen& ground, double levels = 8);

/// Connected pieces (8 neighbours) that differ from `ground` by more than `levels`; 0: none.
int pieces_in(const Seen& seen, const Seen& ground, double levels = 8);

}  // namespace prismesh::viewer

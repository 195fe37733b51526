// Patterns of the calibration: fields of plain colour, one for each eye, and stripes and bars on the panel's own pixels.
#pragma once

#include <array>
#include <vector>

namespace prismesh::kiosk::calibration {

using Colour = std::array<float, 3>;  ///< display values, 0..1

/// A rectangle with one colour for each eye. Coordinates are shares of the picture, from its upper left corner.
struct Field {
  double x0 = 0, y0 = 0, x1 = 1, y1 = 1;
  Colour left{};
  Colour right{};
  bool operator==(const Field&) const = default;
};

/// Vertical stripes on the panel's own pixels, in two alternating colours.
struct Stripes {
  double x0 = 0, y0 = 0, x1 = 1, y1 = 1;
  int pixels = 1;  ///< width of a stripe; an even stripe starts at a multiple of twice this
  Colour even{};
  Colour odd{};
  bool operator==(const Stripes&) const = default;
};

/// A horizontal bar to measure with a ruler.
struct Bar {
  int pixels = 1;  ///< length
  bool operator==(const Bar&) const = default;
};

struct Pattern {
  Colour ground{};               ///< for both eyes
  std::vector<Field> fields;     ///< later ones cover earlier ones
  std::vector<Stripes> stripes;  ///< stripes and bars need a picture without stereo, whose pixels are the panel's
  std::vector<Bar> bars;
  bool on_panel() const { return !stripes.empty() || !bars.empty(); }
  bool operator==(const Pattern&) const = default;
};

/// White for the left eye and black for the right one, or the reverse.
Pattern one_eye_bright(bool left);
/// Two fields side by side: stripes of one pixel and of two. They look alike unless colours arrive at half width.
Pattern colour_stripes();
/// Both halves have the same grey for one eye. The other eye's halves are black and white: the grey differs by the crosstalk that isn't
/// compensated.
Pattern crosstalk_patches(bool left);
/// A bar to measure, as long as a picture of this width allows.
Pattern ruler_bar(int picture_width);
/// A mark for each eye, at its own position in the picture, and a frame for both.
Pattern eye_marks();

}  // namespace prismesh::kiosk::calibration

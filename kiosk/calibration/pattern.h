// What the calibration shows: fields of plain colour, for each eye its own, or for the panel's pixels whatever eye they go to. Plain data.
#pragma once

#include <array>
#include <vector>

namespace prismesh::kiosk::calibration {

using Colour = std::array<float, 3>;  ///< display values, 0..1

/// A field; places are shares of the picture, from its upper left corner.
struct Field {
  double x0 = 0, y0 = 0, x1 = 1, y1 = 1;
  Colour left{};
  Colour right{};
  bool operator==(const Field&) const = default;
};

/// Upright stripes on the panel's own pixels, in two colours by turns.
struct Stripes {
  double x0 = 0, y0 = 0, x1 = 1, y1 = 1;
  int pixels = 1;  ///< width of a stripe; the first begins at a multiple of twice this
  Colour even{};
  Colour odd{};
  bool operator==(const Stripes&) const = default;
};

/// A bar of so many pixels, for a ruler.
struct Bar {
  int pixels = 1;
  bool operator==(const Bar&) const = default;
};

struct Pattern {
  Colour ground{};               ///< of both eyes
  std::vector<Field> fields;     ///< later ones cover earlier ones
  std::vector<Stripes> stripes;  ///< stripes and bars are drawn on the panel: the picture has to be of one eye then
  std::vector<Bar> bars;
  bool on_panel() const { return !stripes.empty() || !bars.empty(); }
  bool operator==(const Pattern&) const = default;
};

/// The left eye sees everything bright and the right eye everything dark, or the other way round.
Pattern one_eye_bright(bool left);
/// Beside each other: stripes of one pixel and of two. They look alike unless colours arrive at half width.
Pattern colour_stripes();
/// Both halves are the same grey to one eye; the other eye sees black on the left and white on the right, which shines through as far as
/// the crosstalk is not corrected.
Pattern crosstalk_patches(bool left);
/// A bar to measure, as long as a picture of this width allows.
Pattern ruler_bar(int picture_width);
/// Each eye has a sign of its own, in its own corner of the picture, and both share a frame.
Pattern eye_signs();

}  // namespace prismesh::kiosk::calibration

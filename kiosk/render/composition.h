// How a picture is composed for its display: which images are drawn, from where and what part of the scene each of their texels shows,
// and which image every (sub)pixel of the display takes its colour from. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/display/phase_map.h"
#include "kiosk/render/picture.h"

namespace prismesh::kiosk::render {

/// One image and where it is drawn from.
struct ComposedImage {
  std::optional<stereo::Eye> eye;  ///< empty: the picture from between the eyes
  Vec3 eye_mm = Vec3(0, 0, 650);   ///< from the picture's centre
  int width = 1, height = 1;
  stereo::ImageMap from_picture = stereo::ImageMap::Zero();
  bool operator==(const ComposedImage&) const = default;
};

/// How the images become one picture.
enum class Join : std::uint8_t {
  alone,       ///< the only image is the picture
  interlaced,  ///< each (sub)pixel shows the eye whose number is nearer to an integer, at the texel of that number
  stencil,     ///< each pixel shows that eye, at its own place
  anaglyph,    ///< red from the one, green and blue from the other
  beside,      ///< one on the left, the other on the right
  stacked,     ///< one on top, the other below
};

struct Composition {
  std::vector<ComposedImage> images;  ///< left and right eye, or the only one. One for both eyes where `join` needs two: they are alike
  Join join = Join::alone;
  bool swapped = false;              ///< anaglyph, beside, stacked: the right eye's is the first
  bool by_rows = false;              ///< numbers count rows, from the lower edge up; else columns
  double subpixel = 0;               ///< columns from a pixel's middle to its blue part: 1/3, or -1/3; 0: whole pixels
  std::array<double, 2> leak{0, 0};  ///< crosstalk to be taken out, of the left and the right eye; `gamma` is the panel's
  double gamma = 2.2;
  drivers::display::PhaseMap phases;  ///< of interlaced and stencil
};

/// Composes a picture of width x height pixels. Eyes that aren't finite are taken to be at the design place.
Composition compose(const Picture& picture, int width, int height);

}  // namespace prismesh::kiosk::render

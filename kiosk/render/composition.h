// Plans a picture for its display: which images are drawn, from which viewpoint, which part of the scene each of their texels shows, and
// from which image every (sub)pixel of the display takes its colour. No OpenGL.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/display/phase_map.h"
#include "kiosk/render/picture.h"

namespace prismesh::kiosk::render {

/// One image and its viewpoint.
struct ComposedImage {
  std::optional<stereo::Eye> eye;  ///< empty: the picture from between the eyes
  Vec3 eye_mm = Vec3(0, 0, 650);   ///< viewpoint, mm from the picture's centre
  int width = 1, height = 1;
  stereo::ImageMap from_picture = stereo::ImageMap::Zero();  ///< pixels of the picture to the image
  bool operator==(const ComposedImage&) const = default;
};

/// How the images become one picture.
enum class Join : std::uint8_t {
  alone,       ///< the only image is the picture
  interlaced,  ///< each (sub)pixel shows the eye whose number in `phases` is nearer to an integer, at that texel
  stencil,     ///< each pixel shows that eye, at the pixel itself
  anaglyph,    ///< red from the left eye, green and blue from the right one
  beside,      ///< left and right half
  stacked,     ///< upper and lower half
};

struct Composition {
  std::vector<ComposedImage> images;  ///< left and right eye, or only one. If `join` needs two, the one stands for both
  Join join = Join::alone;
  bool swapped = false;               ///< anaglyph, beside, stacked: the right eye's image is the first
  bool by_rows = false;               ///< `phases` counts rows, from the lower edge up; else columns
  double subpixel = 0;                ///< columns from a pixel's middle to its blue subpixel: 1/3 or -1/3; 0: whole pixels
  std::array<double, 2> leak{0, 0};   ///< crosstalk to compensate, of the left and the right eye
  double gamma = 2.2;                 ///< the panel's
  drivers::display::PhaseMap phases;  ///< for interlaced and stencil
};

/// Composes a picture of width x height pixels. Eye positions that aren't finite are replaced by the default ones.
Composition compose(const Picture& picture, int width, int height);

}  // namespace prismesh::kiosk::render

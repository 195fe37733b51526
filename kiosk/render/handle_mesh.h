// The handle as triangles in screen millimetres, the same for both eyes: pure.
#pragma once

#include <array>
#include <vector>

#include "kiosk/render/picture.h"

namespace prismesh::kiosk::render {

struct HandleVertex {
  std::array<float, 3> at;       ///< screen mm
  std::array<float, 3> outward;  ///< normal
};

/// One part of a handle, in one colour.
struct HandlePiece {
  std::vector<HandleVertex> triangles;  ///< counterclockwise seen from outside
  bool active = false;                  ///< what is in use
  bool sheet = false;                   ///< seen from both sides and through
  float alpha = 1;
};

/// What its size on the screen depends on.
struct HandleSpace {
  const stereo::View& view;
  double mm_per_pixel = 0.28;
  double viewer_mm = 650;  ///< before the screen
  stereo::Box around;      ///< the model, deck coordinates: how long an axis is drawn
};

/// In the order to draw them. Empty for a handle that isn't anywhere.
std::vector<HandlePiece> handle_pieces(const Handle& handle, const HandleSpace& space);

}  // namespace prismesh::kiosk::render

// The handle as triangles around an axis of length 1, radii in pixels: its arrow, and the ring about its foot.
#pragma once

#include <array>
#include <vector>

namespace prismesh::kiosk::render {

struct HandleVertex {
  std::array<float, 2> circle;  ///< direction out of the axis: cosine and sine
  std::array<float, 2> stem;    ///< place along the axis 0..1, radius in pixels
  std::array<float, 2> slant;   ///< normal: share out of the axis, share along it
};

/// Triangles, counterclockwise seen from outside.
std::vector<HandleVertex> arrow_mesh();
std::vector<HandleVertex> ring_mesh();

}  // namespace prismesh::kiosk::render

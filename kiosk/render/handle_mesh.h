// Builds the handle as triangles in screen millimetres, the same for both eyes. No OpenGL.
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
  bool active = false;                  ///< being dragged
  bool sheet = false;                   ///< a surface seen from both sides, translucent
  float alpha = 1;
};

/// What the handle's size on the screen depends on.
struct HandleSpace {
  const stereo::View& view;
  double mm_per_pixel = 0.28;
  double viewer_mm = 650;  ///< distance of the viewer from the screen
  stereo::Box around;      ///< box around the model, deck coordinates: an axis is drawn through all of it
};

/// The handle's pieces in drawing order. Empty if position or direction isn't finite, or the direction is zero.
std::vector<HandlePiece> handle_pieces(const Handle& handle, const HandleSpace& space);

/// The arrow that drags a cut, and the outline of the model's box in its plane. Empty as above.
std::vector<HandlePiece> cut_pieces(const Handle& handle, const HandleSpace& space);

/// The pen's pieces in drawing order: the touched shell, the node, the tip, the shaft. Empty if tip or shaft isn't finite, or the shaft is
/// zero.
std::vector<HandlePiece> pen_pieces(const Pen& pen, const HandleSpace& space);
inline constexpr double kPenLengthPixels = 170;  ///< if it is parallel to the screen

/// A ball at a point, and a ring about it in the screen's plane, of the active colour. Empty if the point isn't finite.
std::vector<HandlePiece> mark_pieces(const Vec3& point, const HandleSpace& space);

/// Thin tubes along ways, with a ball at each of their points. Points that aren't finite are left out.
HandlePiece measures_piece(const std::vector<std::vector<Vec3>>& ways, const HandleSpace& space);

/// Tubes along edges, of the active colour. Edges that aren't finite are left out.
HandlePiece followed_edges_piece(const std::vector<std::array<Vec3, 2>>& edges, const HandleSpace& space);

/// Tubes along the pieces of the line where a pull falls to half, white. Pieces that aren't finite are left out.
HandlePiece halfway_piece(const std::vector<std::array<Vec3, 2>>& pieces, const HandleSpace& space);

}  // namespace prismesh::kiosk::render

// Places the planes that shadows are drawn on: along the deck's axes beside the model, on the sides turned away from the viewer
// [Herndon 1992]. No OpenGL.
#pragma once

#include <optional>
#include <vector>

#include "kiosk/stereo/pointer.h"

namespace prismesh::kiosk::render {

using mesh::Vec3;

/// A rectangle perpendicular to the deck's axis 0..2.
struct ShadowPlane {
  int axis = 0;
  Vec3 low = Vec3::Zero();  ///< corners, deck coordinates; the same coordinate along `axis`
  Vec3 high = Vec3::Zero();
};

/// Up to three planes at a small distance from a box (deck coordinates). A plane seen nearly edge-on is left out; an empty box has none.
std::vector<ShadowPlane> shadow_planes(const stereo::Box& box, const stereo::View& view);

struct ShadowPoint {
  ShadowPlane plane;
  Vec3 at = Vec3::Zero();  ///< on the plane, deck coordinates
};
/// The plane nearest to the eye at a pixel, whether or not the model covers it.
std::optional<ShadowPoint> shadow_plane_at(const stereo::Aim& aim, const stereo::Box& box, const Eigen::Vector2d& pixel);

}  // namespace prismesh::kiosk::render

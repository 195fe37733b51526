// Where the shadows of what is dragged fall: planes along the deck's axes beside the model, on the sides turned away from the viewer
// (K. P. Herndon et al., "Interactive Shadows", 1992). Pure.
#pragma once

#include <optional>
#include <vector>

#include "kiosk/stereo/pointer.h"

namespace prismesh::kiosk::render {

using mesh::Vec3;

/// A rectangle across the deck's axis 0..2.
struct ShadowPlane {
  int axis = 0;
  Vec3 low = Vec3::Zero();  ///< corners, deck coordinates; equal along the axis
  Vec3 high = Vec3::Zero();
};

/// Beside a box, a little way off. A plane seen nearly from its edge is left out; an empty box has none.
std::vector<ShadowPlane> shadow_planes(const stereo::Box& box, const stereo::View& view);

struct ShadowPlace {
  ShadowPlane plane;
  Vec3 at = Vec3::Zero();  ///< on it, deck coordinates
};
/// The nearest plane under a pixel. What of the model is there as well isn't asked.
std::optional<ShadowPlace> shadow_plane_at(const stereo::Aim& aim, const stereo::Box& box, const Eigen::Vector2d& pixel);

}  // namespace prismesh::kiosk::render

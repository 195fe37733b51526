// The line on the surface where a pull moves nodes half as far as the hand. Dragging it sets the flat top of the falloff.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "ipc/model/messages.h"
#include "kiosk/input/gestures.h"
#include "kiosk/stereo/pointer.h"
#include "mesh/shape/weights.h"

namespace prismesh::kiosk::tools::shaping {

using HalfwayLine = std::vector<std::array<mesh::Vec3, 2>>;  ///< ends of its pieces, deck coordinates

HalfwayLine halfway_line(const ipc::FollowedEdges& answer);

/// The point of the line nearest to a pixel, deck coordinates; nothing: no piece is within reach.
std::optional<mesh::Vec3> ring_at(const stereo::Aim& aim, const HalfwayLine& line, const input::Pixel& pixel);
/// The line as it is seen. Pieces behind the eye are left out.
std::vector<std::vector<input::Pixel>> ring_in_picture(const stereo::Aim& aim, const HalfwayLine& line);

/// d (docs/shaping.md) at which the weight is a half: 1 at the origin, 0 at the border. 0 where it never is.
double halfway_share(const mesh::shape::Falloff& falloff);

/// One drag of the line. Along a ray from the handle's foot, d is taken to fall evenly from 1 there to 0 at the border.
class RingDrag {
 public:
  RingDrag(const mesh::shape::Falloff& falloff, const input::Pixel& foot, const input::Pixel& taken);
  /// The flat top that brings the line under a pixel: 0..kFlattest, in steps of 0.02. 0 where even without a flat top the pull reaches
  /// farther.
  double flat_at(const input::Pixel& pixel) const;
  static constexpr double kFlattest = 0.96;

 private:
  input::Pixel foot_;
  double border_ = 0;   ///< of the selection from the foot, pixels
  double halfway_ = 0;  ///< share without a flat top
};

}  // namespace prismesh::kiosk::tools::shaping

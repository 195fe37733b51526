// An arrow that is pulled along its length: where the pointer brings it.
#pragma once

#include <vector>

#include "kiosk/input/gestures.h"
#include "kiosk/stereo/pointer.h"

namespace prismesh::kiosk::toolkit {

/// Whether the arrow of a handle is so foreshortened that it can't be followed along its length: then it is pulled by moving upward.
bool points_at_viewer(const stereo::Aim& aim, const mesh::Vec3& at, const mesh::Vec3& direction);

/// The arrow's line in the picture, from foot to tip: no line if it is behind the eye.
std::vector<std::vector<input::Pixel>> arrow_line(const stereo::Aim& aim, const mesh::Vec3& at, const mesh::Vec3& direction);

/// One pull of an arrow, from taking it to letting it go.
class ArrowPull {
 public:
  /// `at`: its foot, `direction`: unit; deck coordinates.
  ArrowPull(const stereo::Aim& aim, const mesh::Vec3& at, const mesh::Vec3& direction, const input::Pixel& pixel);
  /// How far the pointer brings it along its direction, deck's length unit.
  double distance(const stereo::Aim& aim, const input::Pixel& pixel) const;
  mesh::Vec3 foot(double distance) const { return at_ + direction_ * distance; }
  /// The view has changed: from now on this pixel means this distance.
  void hold(const stereo::Aim& aim, const input::Pixel& pixel, double distance);

 private:
  double raw(const stereo::Aim& aim, const input::Pixel& pixel) const;

  mesh::Vec3 at_, direction_;
  input::Pixel taken_ = input::Pixel::Zero();
  bool upward_ = false;    ///< it points at the viewer since the pixel was last held
  double when_taken_ = 0;  ///< raw
  double held_ = 0;        ///< the distance that it stood for
};

}  // namespace prismesh::kiosk::toolkit

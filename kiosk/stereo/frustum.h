// What an eye sees through the screen's window: generalised perspective projection (R. Kooima, "Generalized Perspective
// Projection", 2008); and from where pictures are drawn.
#pragma once

#include <optional>

#include <Eigen/Core>

#include "drivers/display/eyes.h"
#include "kiosk/stereo/view.h"

namespace prismesh::kiosk::stereo {

using drivers::display::Eye;
using drivers::display::EyePair;
using drivers::display::eyes_from;
using drivers::display::kMeanEyeSeparationMm;

/// Who looks at the picture. Millimetres from the screen's centre.
struct PictureEyes {
  Vec3 between_mm = Vec3(0, 0, 650);
  Vec3 toward_right = Vec3::UnitX();  ///< from the left eye to the right one; any length but zero
  double separation_mm = kMeanEyeSeparationMm;
  double depth_share = 1;  ///< how much of their separation the pictures are drawn with; 0: both from between them

  /// The eyes where they are.
  EyePair eyes() const;
  /// Where an eye's picture is drawn from; empty: the one from between them.
  Vec3 picture_eye(std::optional<Eye> eye) const;
};

struct DepthRange {
  double near_mm = 50;  ///< from the eye, along the screen's normal; > 0
  double far_mm = 5000;
};
/// The range that holds everything the view shows, with room for handles, as tight as that allows.
DepthRange depth_range(const View& view, const Vec3& eye_mm);

/// Screen millimetres to clip space for an eye (z > 0) before a screen of w x h mm: the screen's corners land on the corners of
/// the picture whatever the eye. Column vectors; clip z in -w..w.
Eigen::Matrix4d clip_from_screen(const Vec3& eye_mm, const Eigen::Vector2d& screen_mm, const DepthRange& range);

/// An affine map from places in the picture (pixels from the upper left corner) to an image's normalised coordinates (-1..1, y up).
using ImageMap = Eigen::Matrix<double, 2, 3>;
/// The map of an image that is the picture.
ImageMap whole_picture(int width, int height);
/// A projection onto a picture of width x height pixels, turned into the one onto an image of it.
Eigen::Matrix4d clip_onto(const ImageMap& image, const Eigen::Matrix4d& clip, int width, int height);

}  // namespace prismesh::kiosk::stereo

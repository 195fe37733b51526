// Projects the scene for an eye through the screen as a window: generalised perspective projection [Kooima 2008]. Computes the viewpoints
// that pictures are drawn from.
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

/// The viewer's eyes, in millimetres from the screen's centre.
struct PictureEyes {
  Vec3 between_mm = Vec3(0, 0, 650);
  Vec3 toward_right = Vec3::UnitX();  ///< from the left eye to the right one; any length but zero
  double separation_mm = kMeanEyeSeparationMm;
  double depth_share = 1;  ///< share of their separation that the pictures are drawn with; 0: both from between them

  /// The positions of the eyes.
  EyePair eyes() const;
  /// The viewpoint of an eye's picture; without `eye` that of the picture from between them.
  Vec3 picture_eye(std::optional<Eye> eye) const;
};

struct DepthRange {
  double near_mm = 50;  ///< from the eye, along the screen's normal; > 0
  double far_mm = 5000;
};
/// The smallest range that contains the view's bounds and a margin for handles and glyphs.
DepthRange depth_range(const View& view, const Vec3& eye_mm);
/// The range extended to what is at this depth in screen space (mm) and about it. A depth that isn't finite changes nothing.
DepthRange with_depth(const DepthRange& range, const Vec3& eye_mm, double depth_mm);

/// Maps screen millimetres to clip space for an eye (z > 0) in front of a screen of w x h mm. The screen's corners map to the picture's
/// corners for every eye. Column vectors; clip z in -w..w.
Eigen::Matrix4d clip_from_screen(const Vec3& eye_mm, const Eigen::Vector2d& screen_mm, const DepthRange& range);

/// An affine map from points of the picture (pixels from the upper left corner) to an image's normalised coordinates (-1..1, y up).
using ImageMap = Eigen::Matrix<double, 2, 3>;
/// The map of an image that covers the whole picture.
ImageMap whole_picture(int width, int height);
/// Converts a projection onto a picture of width x height pixels to one onto an image of it.
Eigen::Matrix4d clip_onto(const ImageMap& image, const Eigen::Matrix4d& clip, int width, int height);

}  // namespace prismesh::kiosk::stereo

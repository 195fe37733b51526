// What an eye sees through the screen's window: generalised perspective projection (R. Kooima, "Generalized Perspective
// Projection", 2008), and the shift that puts half-width images onto their own display columns.
#pragma once

#include <Eigen/Core>

#include "kiosk/stereo/view.h"

namespace prismesh::kiosk::stereo {

enum class Eye : unsigned char { left, right };

struct EyePair {
  Vec3 left;
  Vec3 right;
  const Vec3& of(Eye eye) const { return eye == Eye::left ? left : right; }
};

inline constexpr double kMeanEyeSeparationMm = 63;

/// The eyes from the point between them, on a line parallel to the screen's lower edge.
EyePair eyes_from(const Vec3& between_mm, double separation_mm = kMeanEyeSeparationMm);

struct DepthRange {
  double near_mm = 50;  ///< from the eye, along the screen's normal; > 0
  double far_mm = 5000;
};
/// The range that holds everything the view shows, with room for handles, as tight as that allows.
DepthRange depth_range(const View& view, const Vec3& eye_mm);

/// Screen millimetres to clip space for an eye (z > 0) before a screen of w x h mm: the screen's corners land on the corners of
/// the picture whatever the eye. Column vectors; clip z in -w..w.
Eigen::Matrix4d clip_from_screen(const Vec3& eye_mm, const Eigen::Vector2d& screen_mm, const DepthRange& range);

/// What to add to normalised x so that a half-width image samples the scene where its display columns are: the columns
/// of one eye are centred at 2i + 0.5, the other's at 2i + 1.5, while both images have their texel centres at 2i + 1.
/// `display_columns`: width of the display; `swap`: the right eye has the even columns.
double half_pixel_shift(Eye eye, int display_columns, bool swap);
/// The projection for an eye's half-width image, ceil(display_columns / 2) texels wide, whose texels are dealt out to alternate columns:
/// the half-pixel shift, and for an odd width the one column that the image is too wide.
Eigen::Matrix4d clip_for_columns(const Eigen::Matrix4d& clip, Eye eye, int display_columns, bool swap);
/// The same for half-width images whose texels stay together, each as wide as two columns.
Eigen::Matrix4d clip_for_half_width(const Eigen::Matrix4d& clip, int display_columns);

}  // namespace prismesh::kiosk::stereo

#include "kiosk/stereo/frustum.h"

#include <algorithm>

namespace prismesh::kiosk::stereo {

namespace {
constexpr double kNearestMm = 10;     ///< no nearer than this to the eye, so that depth keeps its resolution
constexpr double kRoomMm = 40;        ///< for what stands out of the model: handles, glyphs
constexpr double kNearestEyeMm = 20;  ///< an eye nearer than this, or behind the screen, is taken to be here
}  // namespace

EyePair eyes_from(const Vec3& between_mm, double separation_mm) {
  const Vec3 half(0.5 * separation_mm, 0, 0);
  return {between_mm - half, between_mm + half};
}

DepthRange depth_range(const View& view, const Vec3& eye_mm) {
  const auto [behind, before] = depth_extent(view);
  const double eye = std::max(eye_mm.z(), kNearestEyeMm);
  const double near_mm = std::max(kNearestMm, eye - before - kRoomMm);
  return {near_mm, std::max(eye - behind + kRoomMm, near_mm + kRoomMm)};
}

Eigen::Matrix4d clip_from_screen(const Vec3& eye_mm, const Eigen::Vector2d& screen_mm, const DepthRange& range) {
  const Vec3 eye(eye_mm.x(), eye_mm.y(), std::max(eye_mm.z(), kNearestEyeMm));
  const double n = range.near_mm, f = range.far_mm, scale = n / eye.z();
  const double left = (-0.5 * screen_mm.x() - eye.x()) * scale, right = (0.5 * screen_mm.x() - eye.x()) * scale;
  const double bottom = (-0.5 * screen_mm.y() - eye.y()) * scale, top = (0.5 * screen_mm.y() - eye.y()) * scale;
  Eigen::Matrix4d frustum = Eigen::Matrix4d::Zero();
  frustum(0, 0) = 2 * n / (right - left);
  frustum(0, 2) = (right + left) / (right - left);
  frustum(1, 1) = 2 * n / (top - bottom);
  frustum(1, 2) = (top + bottom) / (top - bottom);
  frustum(2, 2) = -(f + n) / (f - n);
  frustum(2, 3) = -2 * f * n / (f - n);
  frustum(3, 2) = -1;
  Eigen::Matrix4d from_eye = Eigen::Matrix4d::Identity();
  from_eye.topRightCorner<3, 1>() = -eye;
  return frustum * from_eye;
}

double half_pixel_shift(Eye eye, int display_columns, bool swap) {
  const bool even_columns = (eye == Eye::left) != swap;
  return (even_columns ? 1.0 : -1.0) / display_columns;
}

Eigen::Matrix4d clip_for_columns(const Eigen::Matrix4d& clip, Eye eye, int display_columns, bool swap) {
  Eigen::Matrix4d shifted = clip;
  shifted.row(0) += half_pixel_shift(eye, display_columns, swap) * clip.row(3);
  return clip_for_half_width(shifted, display_columns);
}

Eigen::Matrix4d clip_for_half_width(const Eigen::Matrix4d& clip, int display_columns) {
  const double covered = 2 * ((display_columns + 1) / 2);  // columns that the image stands for
  const double share = display_columns / covered;
  Eigen::Matrix4d widened = clip;
  widened.row(0) = share * clip.row(0) + (share - 1) * clip.row(3);
  return widened;
}

}  // namespace prismesh::kiosk::stereo

#include "kiosk/stereo/frustum.h"

#include <algorithm>
#include <cmath>

namespace prismesh::kiosk::stereo {

namespace {
constexpr double kMinNearMm = 10;    ///< of the near plane from the eye, so that depth keeps its resolution
constexpr double kPenReachMm = 120;  ///< of a pen beyond its tip
constexpr double kMarginMm = 40;     ///< for what extends beyond the model: handles, glyphs
constexpr double kMinEyeMm = 20;     ///< an eye nearer to the screen, or behind it, is moved to this distance
}  // namespace

EyePair PictureEyes::eyes() const {
  const double length = toward_right.norm();
  return eyes_from(between_mm, separation_mm, length > 0 ? Vec3(toward_right / length) : Vec3(Vec3::UnitX()));
}

Vec3 PictureEyes::picture_eye(std::optional<Eye> eye) const {
  return eye ? Vec3(between_mm + depth_share * (eyes().of(*eye) - between_mm)) : between_mm;
}

DepthRange depth_range(const View& view, const Vec3& eye_mm) {
  const auto [behind, before] = depth_extent(view);
  const double eye = std::max(eye_mm.z(), kMinEyeMm);
  const double near_mm = std::max(kMinNearMm, eye - before - kMarginMm);
  return {near_mm, std::max(eye - behind + kMarginMm, near_mm + kMarginMm)};
}

DepthRange with_depth(const DepthRange& range, const Vec3& eye_mm, double depth_mm) {
  if (!std::isfinite(depth_mm)) return range;
  const double away = std::max(eye_mm.z(), kMinEyeMm) - depth_mm;
  const double near_mm = std::max(kMinNearMm, std::min(range.near_mm, away - kPenReachMm));
  return {near_mm, std::max({range.far_mm, away + kPenReachMm, near_mm + kMarginMm})};
}

Eigen::Matrix4d clip_from_screen(const Vec3& eye_mm, const Eigen::Vector2d& screen_mm, const DepthRange& range) {
  const Vec3 eye(eye_mm.x(), eye_mm.y(), std::max(eye_mm.z(), kMinEyeMm));
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

ImageMap whole_picture(int width, int height) {
  ImageMap map;
  map << 2.0 / width, 0, -1, 0, -2.0 / height, 1;
  return map;
}

Eigen::Matrix4d clip_onto(const ImageMap& image, const Eigen::Matrix4d& clip, int width, int height) {
  Eigen::Matrix3d picture = Eigen::Matrix3d::Identity();  // normalised coordinates to pixels
  picture << 0.5 * width, 0, 0.5 * width, 0, -0.5 * height, 0.5 * height, 0, 0, 1;
  const ImageMap from_picture = image * picture;
  Eigen::Matrix4d onto = clip;
  for (int row = 0; row < 2; ++row)
    onto.row(row) = from_picture(row, 0) * clip.row(0) + from_picture(row, 1) * clip.row(1) + from_picture(row, 2) * clip.row(3);
  return onto;
}

}  // namespace prismesh::kiosk::stereo

#include "kiosk/stereo/pointer.h"

#include <algorithm>
#include <cmath>

namespace prismesh::kiosk::stereo {

namespace {

constexpr double kHandleHalfWidthPixels = 8;  ///< of the arrow's head
constexpr double kMinSlope = 0.06;  ///< min ratio of an axis' length on the screen to its true length; below it a distance is undefined

/// Homogeneous pixel coordinates: x and y are divided by z.
Vec3 pixel_homogeneous(const Aim& aim, const Eigen::Matrix4d& clip, const Eigen::Vector4d& point) {
  const Eigen::Vector4d c = clip * point;
  return {0.5 * (c.x() + c.w()) * aim.width, 0.5 * (c.w() - c.y()) * aim.height, c.w()};
}

/// Magnification of what is at the point's depth, relative to the screen's plane.
double magnification(const Aim& aim, const Vec3& deck_point) {
  const double depth = std::max(aim.eye_mm.z() - to_screen(aim.view, deck_point).z(), 1.0);
  return aim.eye_mm.z() / depth;
}

}  // namespace

Eigen::Matrix4d Aim::clip_from_deck() const {
  return clip_from_screen(eye_mm, screen_mm, depth_range(view, eye_mm)) * screen_from_deck(view);
}

Aim aim_for(const View& view, const Profile& profile, const PictureEyes& eyes, int width, int height) {
  Aim aim;
  aim.view = view;
  aim.eye_mm = eyes.picture_eye(profile.weave == Weave::centre ? std::nullopt : std::optional(profile.eye));
  aim.screen_mm = screen_size_mm(profile, width, height);
  aim.width = width;
  aim.height = height;
  return aim;
}

Eigen::Matrix4d clip_with_cut(const Aim& aim, const Vec3& point, const Vec3& normal) {
  const Eigen::Matrix4d clip = aim.clip_from_deck();
  Eigen::RowVector4d below;  // above 0 where the model is kept
  below << -normal.transpose(), normal.dot(point);
  const Vec3 eye = to_deck(aim.view, aim.eye_mm);
  const double at_eye = below * eye.homogeneous();
  const bool near = at_eye < 0;
  // The least scale that keeps what is seen between the planes: the other plane goes through the corner that is farthest below.
  const Eigen::Matrix4d deck = clip.inverse();
  double farthest = 0;
  for (int corner = 0; corner < 4; ++corner) {
    const Eigen::Vector4d at = deck * Eigen::Vector4d(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, near ? 1 : -1, 1);
    const double w = clip.row(3) * at;
    farthest = std::max(farthest, double(below * at) / w);
  }
  if (at_eye == 0 || !(farthest > 0) || !std::isfinite(farthest)) return clip;
  Eigen::Matrix4d cut = clip;
  cut.row(2) = near ? Eigen::RowVector4d(2 / farthest * below - clip.row(3)) : Eigen::RowVector4d(clip.row(3) - 2 / farthest * below);
  return cut;
}

std::optional<Eigen::Vector2d> pixel_of(const Aim& aim, const Vec3& deck_point) {
  const Vec3 pixel = pixel_homogeneous(aim, aim.clip_from_deck(), deck_point.homogeneous());
  if (!(pixel.z() > 0)) return std::nullopt;
  return Eigen::Vector2d(pixel.head<2>() / pixel.z());
}

Eigen::Vector2d mm_of_pixel(const Aim& aim, const Eigen::Vector2d& pixel) {
  return {(pixel.x() / aim.width - 0.5) * aim.screen_mm.x(), (0.5 - pixel.y() / aim.height) * aim.screen_mm.y()};
}

Ray ray_through(const Aim& aim, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d mm = mm_of_pixel(aim, pixel);
  const Vec3 eye = to_deck(aim.view, aim.eye_mm);
  return {eye, to_deck(aim.view, Vec3(mm.x(), mm.y(), 0)) - eye};
}

std::optional<double> distance_along(const Aim& aim, const Vec3& point, const Vec3& direction, const Eigen::Vector2d& pixel) {
  const Eigen::Matrix4d clip = aim.clip_from_deck();
  const Vec3 start = pixel_homogeneous(aim, clip, point.homogeneous());
  const Vec3 step = pixel_homogeneous(aim, clip, Eigen::Vector4d(direction.x(), direction.y(), direction.z(), 0));
  if (!(start.z() > 0)) return std::nullopt;
  const Eigen::Vector2d at = start.head<2>() / start.z();
  const Eigen::Vector2d tangent = (step.head<2>() - at * step.z()) / start.z();  // pixels per deck unit
  const double full_length = aim.view.mm_per_unit / aim.mm_per_pixel();
  if (!(tangent.norm() > kMinSlope * full_length)) return std::nullopt;
  // A line stays a line in the picture: project the pixel onto it, then solve (start + t step) for that point.
  const Eigen::Vector2d along = tangent.normalized();
  const double wanted = along.dot(pixel);
  const double slope = along.dot(step.head<2>()) - wanted * step.z();
  const double distance = (wanted * start.z() - along.dot(start.head<2>())) / slope;
  if (!std::isfinite(distance) || !(start.z() + distance * step.z() > 0)) return std::nullopt;
  return distance;
}

Vec3 displacement_in_screen_plane(const Aim& aim, const Vec3& point, const Eigen::Vector2d& pixel) {
  const Vec3 mm = to_screen(aim.view, point);
  const Eigen::Vector2d on_screen = mm_of_pixel(aim, pixel);
  const double along = (aim.eye_mm.z() - mm.z()) / std::max(aim.eye_mm.z(), 1.0);
  const Eigen::Vector2d target = aim.eye_mm.head<2>() + along * (on_screen - aim.eye_mm.head<2>());
  return to_deck(aim.view, Vec3(target.x(), target.y(), mm.z())) - point;
}

Vec3 handle_tip(const Aim& aim, const Vec3& point, const Vec3& direction) {
  const double length = kHandleLengthPixels * aim.mm_per_pixel() / (aim.view.mm_per_unit * magnification(aim, point));
  return point + direction.normalized() * length;
}

bool on_handle(const Aim& aim, const Vec3& point, const Vec3& direction, const Eigen::Vector2d& pixel, double slack) {
  const auto foot = pixel_of(aim, point), tip = pixel_of(aim, handle_tip(aim, point, direction));
  if (!foot || !tip) return false;
  const Eigen::Vector2d axis = *tip - *foot;
  const double length = axis.squaredNorm();
  const double at = length > 0 ? std::clamp((pixel - *foot).dot(axis) / length, 0.0, 1.0) : 0;
  return (pixel - (*foot + at * axis)).norm() <= kHandleHalfWidthPixels + slack;
}

}  // namespace prismesh::kiosk::stereo

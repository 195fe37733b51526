#include "kiosk/stereo/view.h"

#include <algorithm>
#include <cmath>

namespace prismesh::kiosk::stereo {

namespace {

/// Farthest that the bounds can reach from the pivot, before compression, in mm.
double reach_mm(const View& view) { return ((view.bounds.centre - view.pivot).norm() + view.bounds.radius) * view.mm_per_unit; }

std::array<Vec3, 8> corners_of(const Box& box) {
  std::array<Vec3, 8> corners;
  for (std::size_t i = 0; i < 8; ++i)
    corners[i] = {(i & 1 ? box.high : box.low).x(), (i & 2 ? box.high : box.low).y(), (i & 4 ? box.high : box.low).z()};
  return corners;
}

Eigen::Quaterniond from_screen_axes(const Vec3& right, const Vec3& up, const Vec3& toward_viewer) {
  Eigen::Matrix3d rows;
  rows.row(0) = right.normalized();
  rows.row(1) = up.normalized();
  rows.row(2) = toward_viewer.normalized();
  return Eigen::Quaterniond(rows);
}

}  // namespace

Sphere sphere_around(const Box& box) {
  if (box.empty()) return {};
  const double radius = 0.5 * (box.high - box.low).norm();
  return {0.5 * (box.low + box.high), radius > 0 ? radius : 1};
}

double depth_scale(const View& view) {
  const double reach = reach_mm(view);
  const double allowed = kComfortMargin * std::min(kComfortBeforeMm, kComfortBehindMm);
  return reach > allowed ? allowed / reach : 1;
}

Eigen::Matrix4d screen_from_deck(const View& view) {
  Eigen::Matrix3d linear = view.mm_per_unit * view.rotation.toRotationMatrix();
  linear.row(2) *= depth_scale(view);
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = linear;
  matrix.topRightCorner<3, 1>() = Vec3(view.pan_mm.x(), view.pan_mm.y(), 0) - linear * view.pivot;
  return matrix;
}

Vec3 to_screen(const View& view, const Vec3& deck_point) {
  const Vec3 turned = view.rotation * (deck_point - view.pivot) * view.mm_per_unit;
  return {turned.x() + view.pan_mm.x(), turned.y() + view.pan_mm.y(), turned.z() * depth_scale(view)};
}

Vec3 to_deck(const View& view, const Vec3& screen_mm) {
  const Vec3 turned(screen_mm.x() - view.pan_mm.x(), screen_mm.y() - view.pan_mm.y(), screen_mm.z() / depth_scale(view));
  return view.pivot + view.rotation.conjugate() * (turned / view.mm_per_unit);
}

std::array<double, 2> depth_extent(const View& view) {
  const double reach = reach_mm(view) * depth_scale(view);
  return {-reach, reach};
}

View orbit(const View& view, double right, double up) {
  View turned = view;
  turned.rotation = Eigen::AngleAxisd(right, Vec3::UnitY()) * Eigen::AngleAxisd(-up, Vec3::UnitX()) * view.rotation;
  turned.rotation.normalize();
  return turned;
}

View roll(const View& view, double angle) {
  View turned = view;
  turned.rotation = Eigen::AngleAxisd(angle, Vec3::UnitZ()) * view.rotation;
  turned.rotation.normalize();
  return turned;
}

View pan(const View& view, const Eigen::Vector2d& by_mm) {
  View moved = view;
  moved.pan_mm += by_mm;
  return moved;
}

View zoom(const View& view, double factor, const Eigen::Vector2d& at_mm) {
  View scaled = view;
  scaled.mm_per_unit *= factor;
  scaled.pan_mm = at_mm + (view.pan_mm - at_mm) * factor;
  return scaled;
}

View with_pivot(const View& view, const Vec3& deck_point) {
  View moved = view;
  const Vec3 turned = view.rotation * (deck_point - view.pivot) * view.mm_per_unit;
  moved.pivot = deck_point;
  moved.pan_mm += turned.head<2>();
  return moved;
}

View fit(const View& view, const Box& box, const Eigen::Vector2d& screen_mm, double eye_distance_mm) {
  if (box.empty()) return fit_turned(view, box, screen_mm, eye_distance_mm);
  Box turned;
  for (const Vec3& corner : corners_of(box)) turned.add(view.rotation * corner);
  return fit_turned(view, turned, screen_mm, eye_distance_mm);
}

View fit_turned(const View& view, const Box& turned, const Eigen::Vector2d& screen_mm, double eye_distance_mm) {
  constexpr double kFilled = 0.86;
  constexpr int kRounds = 12;  // the eye's distance makes the size depend on the scale a little: converges in a few
  View fitted = view;
  const Sphere sphere = sphere_around(turned);
  fitted.pivot = view.rotation.conjugate() * sphere.centre;
  fitted.pan_mm.setZero();
  fitted.mm_per_unit = 0.5 * screen_mm.minCoeff() / sphere.radius;
  if (turned.empty()) return fitted;
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Vector2d low = Eigen::Vector2d::Constant(1e300), high = -low;
    for (const Vec3& corner : corners_of(turned)) {
      const Vec3 mm = to_screen(fitted, view.rotation.conjugate() * corner);
      const Eigen::Vector2d seen = mm.head<2>() * eye_distance_mm / std::max(eye_distance_mm - mm.z(), 1.0);
      low = low.cwiseMin(seen);
      high = high.cwiseMax(seen);
    }
    const double too_large = ((high - low).array() / (kFilled * screen_mm).array()).maxCoeff();
    if (!(too_large > 0)) break;
    fitted.pan_mm -= 0.5 * (low + high);
    fitted.pan_mm /= too_large;
    fitted.mm_per_unit /= too_large;
  }
  return fitted;
}

std::optional<Eigen::Quaterniond> named_rotation(std::string_view name) {
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  if (name == "front") return from_screen_axes(x, z, -y);
  if (name == "back") return from_screen_axes(-x, z, y);
  if (name == "right") return from_screen_axes(y, z, x);
  if (name == "left") return from_screen_axes(-y, z, -x);
  if (name == "top") return from_screen_axes(x, y, z);
  if (name == "bottom") return from_screen_axes(x, -y, -z);
  if (name == "iso") {
    const Vec3 toward = Vec3(1, -1, 1).normalized();
    const Vec3 right = z.cross(toward).normalized();
    return from_screen_axes(right, toward.cross(right), toward);
  }
  return std::nullopt;
}

}  // namespace prismesh::kiosk::stereo

#include "kiosk/stereo/view.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace prismesh::kiosk::stereo {

namespace {

constexpr double kMinDepthScale = 0.005;  ///< above 0, so that near surfaces still hide far ones
constexpr double kMinDepthEyeMm = 100;    ///< min distance of the eye when depth is computed from it

/// Distance of the bounds' centre in front of the screen, and their radius: mm, before compression.
struct Depths {
  double centre = 0;
  double radius = 1;
};
Depths depths(const View& view) {
  const Vec3 turned = view.rotation * (view.bounds.centre - view.pivot) * view.mm_per_unit;
  return {turned.z() + view.before_mm, view.bounds.radius * view.mm_per_unit};
}

/// Max factor that keeps both ends of the depths within the limits.
double max_depth_scale(const Depths& depths, const ComfortBox& limits) {
  double scale = 1e9;
  if (depths.centre + depths.radius > 0) scale = std::min(scale, limits.before_mm / (depths.centre + depths.radius));
  if (depths.radius - depths.centre > 0) scale = std::min(scale, limits.behind_mm / (depths.radius - depths.centre));
  return scale;
}

/// mm from the screen's middle.
Eigen::Vector2d place_of_pivot(const View& view) { return view.middle_mm + view.pan_mm; }

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

ComfortBox comfort_box(double eye_distance_mm, double degrees, double separation_mm) {
  const double distance = std::max(eye_distance_mm, kMinDepthEyeMm);
  const double parallax = distance * std::tan(degrees * std::numbers::pi / 180);
  const double max = 0.5 * distance;
  const double behind = parallax < separation_mm ? parallax * distance / (separation_mm - parallax) : max;
  return {std::min(max, parallax * distance / (separation_mm + parallax)), std::min(max, behind)};
}

double depth_scale(const View& view) {
  const double full = max_depth_scale(depths(view), view.comfort);
  return std::max(kMinDepthScale * std::min(1.0, full), std::min(full, view.depth_strength * std::min(1.0, kComfortMargin * full)));
}

Eigen::Matrix4d screen_from_deck(const View& view) {
  const double scale = depth_scale(view);
  Eigen::Matrix3d linear = view.mm_per_unit * view.rotation.toRotationMatrix();
  linear.row(2) *= scale;
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = linear;
  matrix.topRightCorner<3, 1>() = Vec3(place_of_pivot(view).x(), place_of_pivot(view).y(), view.before_mm * scale) - linear * view.pivot;
  return matrix;
}

Vec3 to_screen(const View& view, const Vec3& deck_point) {
  const Vec3 turned = view.rotation * (deck_point - view.pivot) * view.mm_per_unit;
  const Eigen::Vector2d at = place_of_pivot(view);
  return {turned.x() + at.x(), turned.y() + at.y(), (turned.z() + view.before_mm) * depth_scale(view)};
}

Vec3 to_deck(const View& view, const Vec3& screen_mm) {
  const Eigen::Vector2d at = place_of_pivot(view);
  const Vec3 turned(screen_mm.x() - at.x(), screen_mm.y() - at.y(), screen_mm.z() / depth_scale(view) - view.before_mm);
  return view.pivot + view.rotation.conjugate() * (turned / view.mm_per_unit);
}

std::array<double, 2> depth_extent(const View& view) {
  const Depths reach = depths(view);
  const double scale = depth_scale(view);
  return {scale * (reach.centre - reach.radius), scale * (reach.centre + reach.radius)};
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
  const Eigen::Vector2d from_middle = at_mm - view.middle_mm;
  scaled.pan_mm = from_middle + (view.pan_mm - from_middle) * factor;
  scaled.before_mm *= factor;  // what is in the screen's plane stays there
  return scaled;
}

View with_pivot(const View& view, const Vec3& deck_point) {
  View moved = view;
  const Vec3 turned = view.rotation * (deck_point - view.pivot) * view.mm_per_unit;
  moved.pivot = deck_point;
  moved.pan_mm += turned.head<2>();
  moved.before_mm += turned.z();
  return moved;
}

View toward_screen_plane(const View& view, const Vec3& deck_point, const Vec3& eye_mm, double share) {
  const Vec3 before = to_screen(view, deck_point);
  View moved = view;
  moved.before_mm -= share * before.z() / depth_scale(view);
  const Vec3 after = to_screen(moved, deck_point);
  const double eye = std::max(eye_mm.z(), kMinDepthEyeMm);
  const double farther = (eye - after.z()) / std::max(eye - before.z(), 1.0);
  const Eigen::Vector2d wanted = eye_mm.head<2>() + farther * (before.head<2>() - eye_mm.head<2>());
  moved.pan_mm += wanted - after.head<2>();
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
  constexpr int kRounds = 12;  // perspective makes the size on the screen slightly nonlinear in the scale
  View fitted = view;
  const Sphere sphere = sphere_around(turned);
  fitted.pivot = view.rotation.conjugate() * sphere.centre;
  fitted.pan_mm.setZero();
  fitted.before_mm = 0;
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
    fitted.pan_mm -= 0.5 * (low + high) - view.middle_mm;
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

#include "kiosk/render/shadows.h"

#include <cmath>

namespace prismesh::kiosk::render {

namespace {
constexpr double kPlaneGap = 0.04;   ///< distance between box and plane over the box's diagonal
constexpr double kMinFacing = 0.12;  ///< cosine between a plane's normal and the line of sight; below it a shadow can't be read
}  // namespace

std::vector<ShadowPlane> shadow_planes(const stereo::Box& box, const stereo::View& view) {
  std::vector<ShadowPlane> planes;
  if (box.empty()) return planes;
  const Vec3 toward_viewer = view.rotation.conjugate() * Vec3::UnitZ();
  const double off = kPlaneGap * (box.high - box.low).norm();
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(toward_viewer[axis]) < kMinFacing) continue;
    ShadowPlane plane{axis, box.low - Vec3::Constant(off), box.high + Vec3::Constant(off)};
    plane.low[axis] = plane.high[axis] = toward_viewer[axis] > 0 ? plane.low[axis] : plane.high[axis];
    planes.push_back(plane);
  }
  return planes;
}

std::optional<ShadowPoint> shadow_plane_at(const stereo::Aim& aim, const stereo::Box& box, const Eigen::Vector2d& pixel) {
  const stereo::Ray ray = stereo::ray_through(aim, pixel);
  std::optional<ShadowPoint> nearest;
  double nearest_t = 0;
  for (const ShadowPlane& plane : shadow_planes(box, aim.view)) {
    const double t = (plane.low[plane.axis] - ray.origin[plane.axis]) / ray.direction[plane.axis];
    if (!(t > 0) || !std::isfinite(t) || (nearest && t >= nearest_t)) continue;
    Vec3 at = ray.origin + t * ray.direction;
    at[plane.axis] = plane.low[plane.axis];
    if (((at - plane.low).array() < 0).any() || ((plane.high - at).array() < 0).any()) continue;
    nearest = ShadowPoint{plane, at};
    nearest_t = t;
  }
  return nearest;
}

}  // namespace prismesh::kiosk::render

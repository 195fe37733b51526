// The closest point of a triangle, in double precision.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <utility>

#include <Eigen/Geometry>

#include "mesh/model/model.h"

namespace prismesh::mesh::spatial {

/// Square of the height, as a share of the length, below which a triangle counts as its sides.
inline constexpr double kSliver2 = 1e-16;

struct OnTriangle {
  Vec3 point;
  std::array<double, 3> share;
  double distance2 = 0;  ///< from the query point
};

/// By the Voronoi regions of corners, sides and face: [Ericson 2005], "Real-Time Collision Detection", 5.1.5. Of a degenerate triangle the
/// result lies on a side.
inline OnTriangle closest_on_triangle(const std::array<Vec3, 3>& t, const Vec3& p) {
  const Vec3 ab = t[1] - t[0];
  const Vec3 ac = t[2] - t[0];
  const auto on_side = [&](int i, int j) {
    const Vec3 along = t[j] - t[i];
    const double length2 = along.squaredNorm();
    const double s = length2 > 0 ? std::clamp((p - t[i]).dot(along) / length2, 0.0, 1.0) : 0.0;
    OnTriangle on{t[i] + s * along, {}, 0};
    on.share[static_cast<std::size_t>(i)] = 1 - s;
    on.share[static_cast<std::size_t>(j)] = s;
    on.distance2 = (on.point - p).squaredNorm();
    return on;
  };
  const Vec3 normal = ab.cross(ac);
  const double area2 = normal.squaredNorm();
  if (area2 > kSliver2 * ab.squaredNorm() * ac.squaredNorm()) {
    const Vec3 ap = p - t[0];
    const double v = ap.cross(ac).dot(normal) / area2;
    const double w = ab.cross(ap).dot(normal) / area2;
    if (v >= 0 && w >= 0 && v + w <= 1) {
      const Vec3 foot = t[0] + v * ab + w * ac;
      return {foot, {1 - v - w, v, w}, (foot - p).squaredNorm()};
    }
  }
  OnTriangle best = on_side(0, 1);
  for (const auto& [i, j] : {std::pair(1, 2), std::pair(2, 0)}) {
    const OnTriangle other = on_side(i, j);
    if (other.distance2 < best.distance2) best = other;
  }
  return best;
}

/// A bound below the square of the distance, in a third of the time, to leave out what is farther: the distance but for rounding, from
/// products that cancel where a triangle is nearly flat; 0 there.
inline double below_distance2(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
  constexpr double kNearlyFlat = 1e-8;
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const double ab2 = ab.squaredNorm(), ac2 = ac.squaredNorm(), ap2 = ap.squaredNorm(), abac = ab.dot(ac);
  const auto less_rounding = [&](double distance2) { return distance2 * (1 - 1e-6) - 1e-13 * (ap2 + ab2 + ac2); };
  const double area2 = ab2 * ac2 - abac * abac;
  if (!(area2 > kNearlyFlat * ab2 * ac2)) return 0;
  const double on_ab = ab.dot(ap), on_ac = ac.dot(ap);
  const double v = on_ab * ac2 - on_ac * abac, w = on_ac * ab2 - on_ab * abac;
  if (v >= 0 && w >= 0 && v + w <= area2) {
    const double plane = ab.cross(ac).dot(ap);
    return less_rounding(plane * plane / area2);
  }
  // the nearest point is on a side that the point lies beyond
  double best = std::numeric_limits<double>::infinity();
  if (w < 0) {
    const double s = std::clamp(on_ab / ab2, 0.0, 1.0);
    best = std::min(best, ap2 + s * (s * ab2 - 2 * on_ab));
  }
  if (v < 0) {
    const double s = std::clamp(on_ac / ac2, 0.0, 1.0);
    best = std::min(best, ap2 + s * (s * ac2 - 2 * on_ac));
  }
  if (v + w > area2) {
    const Vec3 bc = c - b, bp = p - b;
    const double along = bc.dot(bp), bc2 = bc.squaredNorm();
    const double s = std::clamp(along / bc2, 0.0, 1.0);
    best = std::min(best, bp.squaredNorm() + s * (s * bc2 - 2 * along));
  }
  return less_rounding(best);
}

}  // namespace prismesh::mesh::spatial

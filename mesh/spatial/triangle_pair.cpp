#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "mesh/spatial/distance.h"

namespace prismesh::mesh::spatial {

namespace {

Nearest pair_of(const Vec3& on_a, const Vec3& on_b) { return {(on_b - on_a).squaredNorm(), on_a, on_b}; }

void keep_nearer(Nearest& best, const Nearest& candidate) {
  if (candidate.distance2 < best.distance2) best = candidate;
}

/// Computes the nearest points of the segments p0-p1 and q0-q1: the minimum along both lines, clamped to one segment, then for that point
/// to the other.
Nearest nearest_of_segments(const Vec3& p0, const Vec3& p1, const Vec3& q0, const Vec3& q1) {
  const Vec3 u = p1 - p0, v = q1 - q0, w = p0 - q0;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v), uw = u.dot(w), vw = v.dot(w);
  const auto ratio = [](double numerator, double denominator) {
    return denominator > 0 ? std::clamp(numerator / denominator, 0.0, 1.0) : 0.0;
  };
  // parallel lines have no single minimum; any point will do, since the second clamp finds the nearest point to it
  double s = ratio(uv * vw - uw * vv, uu * vv - uv * uv);
  const double t = ratio(uv * s + vw, vv);
  s = ratio(uv * t - uw, uu);
  return pair_of(p0 + s * u, q0 + t * v);
}

/// The projection of `point` onto the triangle, if it lies inside.
bool foot_inside(const Vec3& point, const Triangle& t, Vec3& foot) {
  const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
  const double nn = normal.squaredNorm();
  if (!(nn > 0)) return false;
  for (std::size_t i = 0; i < 3; ++i)
    if ((t[(i + 1) % 3] - t[i]).cross(point - t[i]).dot(normal) < 0) return false;
  foot = point - normal * ((point - t[0]).dot(normal) / nn);
  return true;
}

/// The point where the segment p-q crosses the triangle, if it does.
bool pierces(const Vec3& p, const Vec3& q, const Triangle& t, Vec3& at) {
  const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
  const double before = (p - t[0]).dot(normal), after = (q - t[0]).dot(normal);
  if (before == after || (before > 0) == (after > 0)) return false;
  const Vec3 crossing = p + (q - p) * (before / (before - after));
  return foot_inside(crossing, t, at);
}

}  // namespace

// Of two triangles that don't cross, the nearest points are a corner of one and its projection onto the other, or lie on an edge of each.
Nearest nearest_of_triangles(const Triangle& a, const Triangle& b) {
  Nearest best;
  best.distance2 = std::numeric_limits<double>::infinity();
  Vec3 at;
  for (std::size_t i = 0; i < 3; ++i) {
    if (pierces(a[i], a[(i + 1) % 3], b, at) || pierces(b[i], b[(i + 1) % 3], a, at)) return {0.0, at, at};
    for (std::size_t j = 0; j < 3; ++j) keep_nearer(best, nearest_of_segments(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]));
    if (foot_inside(a[i], b, at)) keep_nearer(best, pair_of(a[i], at));
    if (foot_inside(b[i], a, at)) keep_nearer(best, pair_of(at, b[i]));
  }
  return best;
}

}  // namespace prismesh::mesh::spatial

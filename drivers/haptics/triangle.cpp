#include "drivers/haptics/triangle.h"

#include <algorithm>

namespace prismesh::drivers::haptics {
namespace {

Eigen::Vector3d nearest_of_segment(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d along = b - a;
  const double square = along.squaredNorm();
  if (!(square > 0)) return a;
  return a + std::clamp((p - a).dot(along) / square, 0.0, 1.0) * along;
}

}  // namespace

Eigen::Vector3d nearest_of_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                    const Eigen::Vector3d& c) {
  const Eigen::Vector3d ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  const double aa = ab.squaredNorm(), bb = ab.dot(ac), cc = ac.squaredNorm();
  const double det = aa * cc - bb * bb;
  const double v = cc * d1 - bb * d2, w = aa * d2 - bb * d1;
  if (det > 1e-12 * aa * cc && v >= 0 && w >= 0 && v + w <= det) return a + (v / det) * ab + (w / det) * ac;
  // Outside of the triangle's prism the nearest point lies on an edge.
  Eigen::Vector3d best = nearest_of_segment(p, a, b);
  for (const Eigen::Vector3d& other : {nearest_of_segment(p, b, c), nearest_of_segment(p, c, a)})
    if ((other - p).squaredNorm() < (best - p).squaredNorm()) best = other;
  return best;
}

}  // namespace prismesh::drivers::haptics

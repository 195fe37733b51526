#include "mesh/quality/verdict.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

namespace prismesh::mesh::quality {

namespace {

constexpr double kNotApplicable = std::numeric_limits<double>::quiet_NaN();

VerdictValues triangle(std::span<const Vec3> p) {
  const std::array<double, 3> sides = {(p[1] - p[0]).norm(), (p[2] - p[1]).norm(), (p[0] - p[2]).norm()};
  const double longest = *std::max_element(sides.begin(), sides.end());
  const double area = 0.5 * (p[1] - p[0]).cross(p[2] - p[0]).norm();
  const double aspect = area > 0 ? longest * (sides[0] + sides[1] + sides[2]) / (4 * std::sqrt(3.0) * area) : kNotApplicable;
  return {aspect, kNotApplicable, kNotApplicable, kNotApplicable, kNotApplicable};
}

}  // namespace

VerdictValues measure_verdict(std::span<const Vec3> p) {
  if (p.size() == 3) return triangle(p);
  std::array<Vec3, 4> edge, normal;
  std::array<double, 4> length{};
  for (std::size_t i = 0; i < 4; ++i) edge[i] = p[(i + 1) % 4] - p[i];
  for (std::size_t i = 0; i < 4; ++i) {
    normal[i] = edge[(i + 3) % 4].cross(edge[i]);
    length[i] = edge[i].norm();
  }
  const Vec3 first = p[1] + p[2] - p[0] - p[3], second = p[2] + p[3] - p[0] - p[1];  // twice the mid-side lines
  const Vec3 centre = first.cross(second);
  if (!(centre.norm() > 0) || !(*std::min_element(length.begin(), length.end()) > 0))
    return {kNotApplicable, kNotApplicable, kNotApplicable, kNotApplicable, kNotApplicable};

  const double perimeter = length[0] + length[1] + length[2] + length[3];
  const double longest = *std::max_element(length.begin(), length.end());
  VerdictValues values{};
  values.verdict_aspect = 0.5 * longest * perimeter / (normal[1].norm() + normal[3].norm());
  values.verdict_skew = std::abs(first.normalized().dot(second.normalized()));
  const double min_cosine =
      std::min(normal[0].normalized().dot(normal[2].normalized()), normal[1].normalized().dot(normal[3].normalized()));
  values.verdict_warpage = min_cosine * min_cosine * min_cosine;
  values.verdict_taper = (p[0] + p[2] - p[1] - p[3]).norm() / std::min(first.norm(), second.norm());
  values.verdict_scaled_jacobian = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 4; ++i)
    values.verdict_scaled_jacobian =
        std::min(values.verdict_scaled_jacobian, normal[i].dot(centre.normalized()) / (length[i] * length[(i + 3) % 4]));
  return values;
}

}  // namespace prismesh::mesh::quality

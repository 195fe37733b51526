#include "mesh/quality/time_step.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "mesh/quality/shell_batch.h"

namespace prismesh::mesh::quality {

namespace {

constexpr int kByBarAndShortestSide = 2;

/// Whether the shell has area, as by Defect::no_area; false where it isn't finite.
bool has_area(std::span<const Vec3> p) {
  const std::size_t count = p.size();
  double longest2 = 0;
  for (std::size_t i = 0; i < count; ++i) longest2 = std::max(longest2, (p[(i + 1) % count] - p[i]).squaredNorm());
  const Vec3 whole = (p[2] - p[0]).cross(p[count - 1] - p[1]);
  const double area = whole.norm();
  if (!(area > kMinArea * longest2)) return false;
  int turned_in = 0;
  for (std::size_t i = 0; i < count; ++i)
    turned_in += (p[i] - p[(i + count - 1) % count]).cross(p[(i + 1) % count] - p[i]).dot(whole) < -kMinArea * area * longest2;
  return turned_in < 2;
}

}  // namespace

double characteristic_length(std::span<const Vec3> corners, int shell_option) {
  const bool is_triangle = corners.size() == 3;
  const Vec3& p0 = corners[0];
  const Vec3& p1 = corners[1];
  const Vec3& p2 = corners[2];
  const Vec3& p3 = corners[is_triangle ? 2 : 3];
  // a triangle counts as a quad whose fourth corner lies on its third, with its area twice and without the side between
  const double area = (is_triangle ? 1.0 : 0.5) * (p2 - p0).cross(p3 - p1).norm();
  const double third = (p3 - p2).norm();
  const double sides[3] = {(p1 - p0).norm(), (p2 - p1).norm(), (p0 - p3).norm()};
  const double longest = std::max(third, *std::max_element(sides, sides + 3));
  const double shortest = *std::min_element(sides, sides + 3);
  const auto over = [area](double length) { return length > 0 ? area / length : 0.0; };
  if (shell_option == 1) return over(std::max((p2 - p0).norm(), (p3 - p1).norm()));
  if (shell_option == kByBarAndShortestSide) return std::max(over(longest), is_triangle ? shortest : std::min(shortest, third));
  return over(longest);
}

std::optional<double> wave_speed(const Part& part, int shell_option) {
  const bool of_bar = shell_option == kByBarAndShortestSide;
  if (!part.limits_time_step || !part.youngs_modulus || !part.density || !(part.poissons_ratio || of_bar)) return std::nullopt;
  const double plane = of_bar ? *part.density : *part.density * (1.0 - *part.poissons_ratio * *part.poissons_ratio);
  if (!(*part.youngs_modulus > 0) || !(plane > 0)) return std::nullopt;
  return std::sqrt(*part.youngs_modulus / plane);
}

std::optional<double> shell_time_step(const Part& part, std::span<const Vec3> corners, int shell_option) {
  const std::optional<double> speed = wave_speed(part, shell_option);
  if (!speed || !has_area(corners)) return std::nullopt;
  const double length = characteristic_length(corners, shell_option);
  if (!(length > 0)) return std::nullopt;
  return length / *speed;
}

}  // namespace prismesh::mesh::quality

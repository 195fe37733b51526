#include "mesh/contact/lift_apart.h"

#include <algorithm>
#include <cmath>

#include "mesh/spatial/distance.h"

namespace prismesh::mesh::contact {

namespace {

constexpr int kMaxLiftSteps = 60;
constexpr double kMinWeight = 1e-3;      ///< of the corners that go: below it they can't lift a point
constexpr double kLiftTolerance = 1e-9;  ///< of the least distance
constexpr double kCornerTolerance = 1e-7;

/// By circles about both, seen along the direction.
bool passes_beside(const Triangle& own, const Triangle& other, const Vec3& direction, double least) {
  const auto centre = [](const Triangle& t) -> Vec3 { return (t[0] + t[1] + t[2]) / 3; };
  const Vec3 of_own = centre(own), of_other = centre(other);
  double radii = least;
  const auto radius = [](const Triangle& t, const Vec3& about) {
    return std::sqrt(std::max({(t[0] - about).squaredNorm(), (t[1] - about).squaredNorm(), (t[2] - about).squaredNorm()}));
  };
  radii += radius(own, of_own) + radius(other, of_other);
  const Vec3 between = of_other - of_own;
  const double along = between.dot(direction);
  return between.squaredNorm() - along * along > 1.000001 * radii * radii;
}

/// The weights of a point of a triangle at its corners.
std::array<double, 3> weights_of(const Triangle& t, const Vec3& point) {
  const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
  std::array<double, 3> weights{1.0 / 3, 1.0 / 3, 1.0 / 3};
  const double area2 = normal.squaredNorm();
  if (!(area2 > 0)) return weights;
  for (std::size_t i = 0; i < 3; ++i)
    weights[i] = std::clamp((t[(i + 2) % 3] - t[(i + 1) % 3]).cross(point - t[(i + 1) % 3]).dot(normal) / area2, 0.0, 1.0);
  return weights;
}

}  // namespace

double lift_apart(const Triangle& moving, const Triangle& fixed, const Vec3& direction, double least) {
  // Relative to a corner, so that the result doesn't depend on where the model is.
  const Vec3 origin = fixed[0];
  Triangle own, other;
  double lowest = 0, highest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    own[i] = moving[i] - origin, other[i] = fixed[i] - origin;
    const double along = own[i].dot(direction), its = other[i].dot(direction);
    lowest = i == 0 ? along : std::min(lowest, along);
    highest = i == 0 ? its : std::max(highest, its);
  }
  if (passes_beside(own, other, direction, least)) return 0;
  double lift = highest - lowest + least;  // beyond it all of `moving` is above all of `fixed`
  if (!(lift > 0)) return 0;
  for (int step = 0; step < kMaxLiftSteps; ++step) {
    Triangle lifted;
    for (std::size_t i = 0; i < 3; ++i) lifted[i] = own[i] + lift * direction;
    const spatial::Nearest nearest = spatial::nearest_of_triangles(lifted, other);
    const double distance = std::sqrt(nearest.distance2);
    const double surplus = distance - least;
    if (surplus <= kLiftTolerance * least) return lift;
    const double slope = (nearest.on_a - nearest.on_b).dot(direction) / distance;
    if (!(slope > 0)) return 0;  // it is clear at its nearest, so everywhere
    lift -= surplus / slope;
    if (!(lift > 0)) return 0;
  }
  return lift;
}

std::optional<double> lift_corners_apart(const Triangle& moving, const std::array<bool, 3>& goes, const Triangle& fixed,
                                         const Vec3& direction, double least) {
  double lift = 0;
  for (int step = 0; step < kMaxLiftSteps; ++step) {
    Triangle now = moving;
    for (std::size_t i = 0; i < 3; ++i)
      if (goes[i]) now[i] += lift * direction;
    const double missing = lift_apart(now, fixed, direction, least);
    if (missing <= kCornerTolerance * least) return lift;
    for (Vec3& corner : now) corner += missing * direction;
    const std::array<double, 3> weights = weights_of(now, spatial::nearest_of_triangles(now, fixed).on_a);
    double weight = 0;
    for (std::size_t i = 0; i < 3; ++i)
      if (goes[i]) weight += weights[i];
    if (weight < kMinWeight) return std::nullopt;
    lift += missing / weight;
  }
  return std::nullopt;
}

}  // namespace prismesh::mesh::contact

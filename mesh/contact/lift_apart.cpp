#include "mesh/contact/lift_apart.h"

#include <algorithm>
#include <cmath>

#include "mesh/spatial/distance.h"

namespace prismesh::mesh::contact {

namespace {

constexpr int kMaxLiftSteps = 60;
constexpr double kLiftTolerance = 1e-9;  ///< of the least distance

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

}  // namespace prismesh::mesh::contact

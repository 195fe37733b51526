#include "mesh/shape/rotate.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "base/deterministic_math.h"
#include "base/parallel_for.h"

namespace prismesh::mesh::shape {

namespace {

constexpr std::size_t kRotateGrain = 1024;
constexpr double kMaxDegrees = 1e9;  // beyond it the deterministic sine isn't accurate

/// The largest angle by which a node at this distance from the axis may turn without going farther than `max_move`, in degrees.
double max_degrees(double max_move, double radius) {
  if (!(max_move < 2 * radius)) return std::numeric_limits<double>::infinity();
  const double half = max_move / (2 * radius);  // the sine of half the angle
  return 2 * deterministic_atan2(half, std::sqrt((1 - half) * (1 + half))) * kDegreesPerRadian;
}

}  // namespace

std::optional<Vec3> unit_of(const Vec3& direction) {
  const double largest = direction.cwiseAbs().maxCoeff();
  if (!direction.allFinite() || !(largest > 0)) return std::nullopt;
  const Vec3 scaled = direction / largest;
  return Vec3(scaled / scaled.norm());
}

std::size_t rotate(std::span<const Vec3> start, std::span<const double> weight, const Rotation& rotation, std::span<Vec3> out) {
  const Axis& axis = rotation.axis;
  if (!(std::abs(rotation.degrees) < kMaxDegrees)) {
    std::fill(out.begin(), out.end(), Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
    return 0;
  }
  std::atomic<std::size_t> stopped = 0;
  parallel_for(start.size(), kRotateGrain, [&](std::size_t begin, std::size_t end) {
    std::size_t stopped_here = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3 from_point = start[i] - axis.point;
      const Vec3 radial = from_point - from_point.dot(axis.direction) * axis.direction;
      double angle = weight[i] * rotation.degrees;
      if (rotation.max_move) {
        const double limit = max_degrees(*rotation.max_move, radial.norm());
        if (std::abs(angle) > limit) {
          angle = std::copysign(limit, angle);
          ++stopped_here;
        }
      }
      const double cosine = deterministic_cos_degrees(angle);
      // a turn by 0 keeps every bit of the position
      out[i] = cosine == 1
                   ? start[i]
                   : Vec3((start[i] - radial) + (cosine * radial + deterministic_sin_degrees(angle) * axis.direction.cross(radial)));
    }
    stopped += stopped_here;
  });
  return stopped;
}

}  // namespace prismesh::mesh::shape

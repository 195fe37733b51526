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
constexpr double kMaxDegrees = 1e9;  // what the deterministic sine is good for

/// By how many degrees a node at this distance from the axis may turn at most, so that it doesn't go farther than `most`.
double degrees_within(double most, double radius) {
  if (!(most < 2 * radius)) return std::numeric_limits<double>::infinity();
  const double half = most / (2 * radius);  // the sine of half the angle
  return 2 * deterministic_atan2(half, std::sqrt((1 - half) * (1 + half))) * kDegreesPerRadian;
}

}  // namespace

std::optional<Vec3> unit_of(const Vec3& direction) {
  const double largest = direction.cwiseAbs().maxCoeff();
  if (!direction.allFinite() || !(largest > 0)) return std::nullopt;
  const Vec3 scaled = direction / largest;
  return Vec3(scaled / scaled.norm());
}

std::size_t rotate(std::span<const Vec3> start, std::span<const double> weight, const Axis& axis, double degrees,
                   std::optional<double> max_move, std::span<Vec3> out) {
  if (!(std::abs(degrees) < kMaxDegrees)) {
    std::fill(out.begin(), out.end(), Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
    return 0;
  }
  std::atomic<std::size_t> stopped = 0;
  parallel_for(start.size(), kRotateGrain, [&](std::size_t begin, std::size_t end) {
    std::size_t stopped_here = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3 from_point = start[i] - axis.point;
      const Vec3 radial = from_point - from_point.dot(axis.direction) * axis.direction;
      double angle = weight[i] * degrees;
      if (max_move) {
        const double most = degrees_within(*max_move, radial.norm());
        if (std::abs(angle) > most) {
          angle = std::copysign(most, angle);
          ++stopped_here;
        }
      }
      const double cosine = deterministic_cos_degrees(angle);
      // a turn by nothing leaves every bit
      out[i] = cosine == 1
                   ? start[i]
                   : Vec3((start[i] - radial) + (cosine * radial + deterministic_sin_degrees(angle) * axis.direction.cross(radial)));
    }
    stopped += stopped_here;
  });
  return stopped;
}

}  // namespace prismesh::mesh::shape

// Fields of simple shapes for tests, filled by the plainest means, and exact tests of collision. Shares no code with the drivers.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "base/haptic_field.h"

namespace prismesh::test {

using Triangle = std::array<Eigen::Vector3d, 3>;
using Triangles = std::vector<Triangle>;

inline Triangles quad(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c, const Eigen::Vector3d& d) {
  return {{a, b, c}, {a, c, d}};
}

/// Distance from a point to a triangle: by its plane where the foot lies inside, else by its edges.
inline double distance_to(const Triangle& t, const Eigen::Vector3d& p) {
  const Eigen::Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]);
  bool inside = normal.squaredNorm() > 0;
  double best = 1e300;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d &from = t[i], edge = t[(i + 1) % 3] - from;
    if (inside && normal.cross(edge).dot(p - from) < 0) inside = false;
    const double s = std::clamp(edge.dot(p - from) / std::max(edge.squaredNorm(), 1e-30), 0.0, 1.0);
    best = std::min(best, (p - from - s * edge).norm());
  }
  return inside ? std::abs(normal.dot(p - t[0])) / normal.norm() : best;
}
inline double distance_to(const Triangles& triangles, const Eigen::Vector3d& p) {
  double best = 1e3;
  for (const Triangle& t : triangles) best = std::min(best, distance_to(t, p));
  return best;
}

/// Whether a segment meets a triangle: by the signs of volumes. Touching counts.
inline bool meets(const Triangle& t, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]);
  const double a = normal.dot(from - t[0]), b = normal.dot(to - t[0]);
  if ((a > 0 && b > 0) || (a < 0 && b < 0)) return false;
  const auto volume = [&](int i) { return (to - from).dot((t[i] - from).cross(t[(i + 1) % 3] - from)); };
  const double u = volume(0), v = volume(1), w = volume(2);
  return (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
}
inline bool meets(const Triangles& triangles, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return std::any_of(triangles.begin(), triangles.end(), [&](const Triangle& t) { return meets(t, from, to); });
}

using Distance = std::function<double(const Eigen::Vector3d&)>;

/// `still`: of what hasn't moved.
template <class DistanceOf, class StillOf>
void fill_brick(HapticBrick& brick, const Eigen::Vector3d& centre_mm, double spacing_mm, std::int32_t count, const DistanceOf& distance,
                const StillOf& still) {
  brick.spacing_mm = spacing_mm;
  for (int axis = 0; axis < 3; ++axis) {
    brick.count[axis] = count;
    brick.origin_mm[axis] = centre_mm[axis] - spacing_mm * (count - 1) / 2;
  }
  std::int32_t i = 0;
  for (std::int32_t z = 0; z < count; ++z)
    for (std::int32_t y = 0; y < count; ++y)
      for (std::int32_t x = 0; x < count; ++x, ++i) {
        const Eigen::Vector3d at(brick.origin_mm[0] + spacing_mm * x, brick.origin_mm[1] + spacing_mm * y,
                                 brick.origin_mm[2] + spacing_mm * z);
        brick.distance_mm[i] = static_cast<float>(distance(at));
        brick.still_mm[i] = static_cast<float>(still(at));
        brick.nearest[i] = 7;
      }
}

struct FieldShape {
  Eigen::Vector3d centre_mm = Eigen::Vector3d::Zero();
  double fine_mm = 0.3175;
  std::int32_t fine_count = 64;
  double coarse_mm = 1.3333;
  std::int32_t coarse_count = 60;
};

inline std::unique_ptr<HapticField> make_field(const Distance& distance, const FieldShape& shape = {}) {
  auto field = std::make_unique<HapticField>();
  field->number = 1;
  field->mesh_generation = 1;
  field->moved_reach_mm = 2 * shape.fine_mm;
  fill_brick(field->fine, shape.centre_mm, shape.fine_mm, shape.fine_count, distance, [](const Eigen::Vector3d&) { return 1e3; });
  fill_brick(field->coarse, shape.centre_mm, shape.coarse_mm, shape.coarse_count, distance, [](const Eigen::Vector3d&) { return 1e3; });
  return field;
}

/// Enters triangles that move into a field whose fine. Both lists have the same order.
inline void enter_moved(HapticField& field, const Triangles& before, const Triangles& now) {
  field.moved_count = static_cast<std::int32_t>(now.size());
  field.max_moved_mm = 0;
  // Each triangle's range of buckets: the box about both places, grown by the reach.
  std::vector<std::array<int, 6>> ranges(now.size());
  const double side = field.fine.spacing_mm * (field.fine.count[0] - 1) / kBucketSide;
  for (std::size_t i = 0; i < now.size(); ++i) {
    Eigen::AlignedBox3d box;
    double radius = 0;
    for (const Triangle& t : {before[i], now[i]}) radius = std::max({radius, (t[1] - t[0]).norm(), (t[2] - t[0]).norm()});
    field.moved[i].radius_mm = static_cast<float>(radius + 1e-3);
    for (int corner = 0; corner < 3; ++corner) {
      field.max_moved_mm = std::max(field.max_moved_mm, (now[i][corner] - before[i][corner]).norm() + 1e-4);
      box.extend(now[i][corner]);
      box.extend(before[i][corner]);
      for (int axis = 0; axis < 3; ++axis) {
        field.moved[i].before_mm[corner][axis] = static_cast<float>(before[i][corner][axis]);
        field.moved[i].now_mm[corner][axis] = static_cast<float>(now[i][corner][axis]);
      }
    }
    for (int axis = 0; axis < 3; ++axis) {
      const auto cell = [&](double mm) {
        return std::clamp(static_cast<int>(std::floor((mm - field.fine.origin_mm[axis]) / side)), -1, kBucketSide);
      };
      ranges[i][axis] = std::max(0, cell(box.min()[axis] - field.moved_reach_mm));
      ranges[i][axis + 3] = std::min(kBucketSide - 1, cell(box.max()[axis] + field.moved_reach_mm));
    }
  }
  std::uint32_t count = 0;
  for (std::int32_t b = 0; b < kBuckets; ++b) {
    field.bucket_begin[b] = count;
    const int at[3] = {b % kBucketSide, b / kBucketSide % kBucketSide, b / kBucketSide / kBucketSide};
    for (std::size_t i = 0; i < ranges.size(); ++i) {
      bool within = true;
      for (int axis = 0; axis < 3; ++axis) within = within && at[axis] >= ranges[i][axis] && at[axis] <= ranges[i][axis + 3];
      if (within) field.bucket_entry[count++] = static_cast<std::uint16_t>(i);
    }
  }
  field.bucket_begin[kBuckets] = count;
}

/// Shapes around the origin.
inline Triangles plane_shape() { return quad({-90, -90, 0}, {90, -90, 0}, {90, 90, 0}, {-90, 90, 0}); }
inline Triangles edge_shape() { return quad({-90, -90, 0}, {0, -90, 0}, {0, 90, 0}, {-90, 90, 0}); }
inline Triangles corner_shape() {
  Triangles all = quad({0, 0, 0}, {70, 0, 0}, {70, 70, 0}, {0, 70, 0});
  for (const Triangles& other :
       {quad({0, 0, 0}, {0, 70, 0}, {0, 70, 70}, {0, 0, 70}), quad({0, 0, 0}, {70, 0, 0}, {70, 0, 70}, {0, 0, 70})})
    all.insert(all.end(), other.begin(), other.end());
  return all;
}
inline Triangles hole_shape() {
  Triangles all;
  const int n = 12;
  const auto at = [&](int i, double radius) {
    const double angle = 2 * 3.14159265358979323846 * i / n;
    return Eigen::Vector3d(radius * std::cos(angle), radius * std::sin(angle), 0);
  };
  for (int i = 0; i < n; ++i)
    for (const Triangle& t : quad(at(i, 3), at(i, 80), at(i + 1, 80), at(i + 1, 3))) all.push_back(t);
  return all;
}
inline Triangles junction_shape() {
  Triangles all = plane_shape();
  for (const Triangle& t : quad({0, -70, 0}, {0, 70, 0}, {0, 70, 70}, {0, -70, 70})) all.push_back(t);
  return all;
}

}  // namespace prismesh::test

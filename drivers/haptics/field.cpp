#include "drivers/haptics/field.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "drivers/haptics/triangle.h"

namespace prismesh::drivers::haptics {
namespace {

/// Errors of the stored distances and of rounding.
constexpr double kRoundingMm = 2e-4;
constexpr double kMaxOriginMm = 1e5;

bool usable_brick(const HapticBrick& brick) {
  if (!(brick.spacing_mm >= 0.01 && brick.spacing_mm <= 10)) return false;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(std::abs(brick.origin_mm[axis]) <= kMaxOriginMm)) return false;
    if (brick.count[axis] < 2 || brick.count[axis] > kMaxBrickSide) return false;
  }
  return true;
}

bool covers(const HapticBrick& brick, const Eigen::Vector3d& at_mm) {
  for (int axis = 0; axis < 3; ++axis) {
    const double from = at_mm[axis] - brick.origin_mm[axis];
    if (!(from >= 0 && from <= brick.spacing_mm * (brick.count[axis] - 1))) return false;
  }
  return true;
}

FieldSample sample_brick(const HapticBrick& brick, const Eigen::Vector3d& at_mm) {
  double share[3];
  std::int32_t cell[3];
  for (int axis = 0; axis < 3; ++axis) {
    const double along = (at_mm[axis] - brick.origin_mm[axis]) / brick.spacing_mm;
    cell[axis] = std::clamp(static_cast<std::int32_t>(along), 0, brick.count[axis] - 2);
    share[axis] = std::clamp(along - cell[axis], 0.0, 1.0);
  }
  const std::int32_t row = brick.count[0], layer = brick.count[0] * brick.count[1];
  const std::int32_t first = cell[0] + row * cell[1] + layer * cell[2];
  const auto at = [&](std::int32_t i) { return static_cast<double>(brick.distance_mm[first + i]); };
  const double d000 = at(0), d100 = at(1), d010 = at(row), d110 = at(row + 1);
  const double d001 = at(layer), d101 = at(layer + 1), d011 = at(layer + row), d111 = at(layer + row + 1);
  FieldSample result;
  for (const double distance : {d000, d100, d010, d110, d001, d101, d011, d111})
    if (!(distance >= 0 && distance < 1e6)) return result;
  const auto [u, v, w] = std::array{share[0], share[1], share[2]};
  const double x00 = d000 + u * (d100 - d000), x10 = d010 + u * (d110 - d010);
  const double x01 = d001 + u * (d101 - d001), x11 = d011 + u * (d111 - d011);
  const double y0 = x00 + v * (x10 - x00), y1 = x01 + v * (x11 - x01);
  const auto mix = [](double from, double to, double s) { return from + s * (to - from); };
  result.known = true;
  result.distance_mm = y0 + w * (y1 - y0);
  result.spacing_mm = brick.spacing_mm;
  result.proved_mm = result.distance_mm - brick.spacing_mm * std::sqrt(u * (1 - u) + v * (1 - v) + w * (1 - w)) - kRoundingMm;
  result.gradient =
      Eigen::Vector3d(mix(mix(d100 - d000, d110 - d010, v), mix(d101 - d001, d111 - d011, v), w), mix(x10 - x00, x11 - x01, w), y1 - y0) /
      brick.spacing_mm;
  result.element = brick.nearest[first + (u > 0.5 ? 1 : 0) + (v > 0.5 ? row : 0) + (w > 0.5 ? layer : 0)];
  return result;
}

Eigen::Vector3d corner_at(const MovedTriangle& triangle, int corner, double part) {
  const auto at = [&](int axis) {
    const double before = triangle.before_mm[corner][axis];
    return before + part * (triangle.now_mm[corner][axis] - before);
  };
  return {at(0), at(1), at(2)};
}

}  // namespace

bool usable(const HapticField& field) {
  if (field.number == 0 || field.mesh_generation == 0) return false;
  if (!usable_brick(field.fine) || !usable_brick(field.coarse)) return false;
  if (field.moved_count < 0 || field.moved_count > kMaxMovedTriangles) return false;
  return field.max_moved_mm >= 0 && field.max_moved_mm < 1e6 && field.moved_reach_mm >= 0 && field.moved_reach_mm < 1e6;
}

FieldSample sample(const HapticField& field, const Eigen::Vector3d& at_mm) {
  if (covers(field.fine, at_mm)) return sample_brick(field.fine, at_mm);
  if (covers(field.coarse, at_mm)) return sample_brick(field.coarse, at_mm);
  return {};
}

MovedNearest nearest_moved(const HapticField& field, const Eigen::Vector3d& at_mm, double part) {
  MovedNearest result;
  if (!covers(field.coarse, at_mm)) return result;
  std::int32_t bucket = 0;
  for (int axis = 2; axis >= 0; --axis) {
    const double along = (at_mm[axis] - field.coarse.origin_mm[axis]) / (field.coarse.spacing_mm * (field.coarse.count[axis] - 1));
    bucket = bucket * kBucketSide + std::clamp(static_cast<std::int32_t>(along * kBucketSide), 0, kBucketSide - 1);
  }
  const std::uint32_t begin = field.bucket_begin[bucket], end = field.bucket_begin[bucket + 1];
  if (begin > end || end > static_cast<std::uint32_t>(kMaxBucketEntries) || end - begin > kMaxTrianglesRead) return result;
  double best = field.moved_reach_mm * field.moved_reach_mm;
  for (std::uint32_t i = begin; i < end; ++i) {
    const std::uint16_t index = field.bucket_entry[i];
    if (index >= field.moved_count) return result;
    const MovedTriangle& triangle = field.moved[index];
    const Eigen::Vector3d point =
        nearest_of_triangle(at_mm, corner_at(triangle, 0, part), corner_at(triangle, 1, part), corner_at(triangle, 2, part));
    const double square = (point - at_mm).squaredNorm();
    if (!(square >= 0)) return result;
    if (square >= best) continue;
    best = square;
    result.point_mm = point;
  }
  result.known = true;
  result.distance_mm = std::sqrt(best);
  return result;
}

}  // namespace prismesh::drivers::haptics

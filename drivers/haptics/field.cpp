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

/// The eight nodes about a place, and the shares of the place between them.
struct CellPlace {
  CellPlace(const HapticBrick& brick, const Eigen::Vector3d& at_mm) {
    std::int32_t cell[3];
    for (int axis = 0; axis < 3; ++axis) {
      const double along = (at_mm[axis] - brick.origin_mm[axis]) / brick.spacing_mm;
      cell[axis] = std::clamp(static_cast<std::int32_t>(along), 0, brick.count[axis] - 2);
      share[axis] = std::clamp(along - cell[axis], 0.0, 1.0);
    }
    row = brick.count[0];
    layer = brick.count[0] * brick.count[1];
    first = cell[0] + row * cell[1] + layer * cell[2];
    const auto [u, v, w] = share;
    error_mm = brick.spacing_mm * std::sqrt(u * (1 - u) + v * (1 - v) + w * (1 - w)) + kRoundingMm;
  }
  std::array<double, 3> share;
  std::int32_t row, layer, first;
  double error_mm;  ///< of the trilinear distance
};

struct TrilinearValue {
  bool known = false;
  double value = 0;
  Eigen::Vector3d slope = Eigen::Vector3d::Zero();  ///< for each cell
};

TrilinearValue trilinear(const float* values, const CellPlace& place) {
  const auto at = [&](std::int32_t i) { return static_cast<double>(values[place.first + i]); };
  const double d000 = at(0), d100 = at(1), d010 = at(place.row), d110 = at(place.row + 1);
  const double d001 = at(place.layer), d101 = at(place.layer + 1), d011 = at(place.layer + place.row),
               d111 = at(place.layer + place.row + 1);
  TrilinearValue result;
  for (const double distance : {d000, d100, d010, d110, d001, d101, d011, d111})
    if (!(distance >= 0 && distance < 1e6)) return result;
  const auto [u, v, w] = place.share;
  const auto mix = [](double from, double to, double s) { return from + s * (to - from); };
  const double x00 = mix(d000, d100, u), x10 = mix(d010, d110, u), x01 = mix(d001, d101, u), x11 = mix(d011, d111, u);
  const double y0 = mix(x00, x10, v), y1 = mix(x01, x11, v);
  result.known = true;
  result.value = mix(y0, y1, w);
  result.slope = {mix(mix(d100 - d000, d110 - d010, v), mix(d101 - d001, d111 - d011, v), w), mix(x10 - x00, x11 - x01, w), y1 - y0};
  return result;
}

FieldSample sample_brick(const HapticBrick& brick, const Eigen::Vector3d& at_mm) {
  const CellPlace place(brick, at_mm);
  const TrilinearValue distance = trilinear(brick.distance_mm, place);
  FieldSample result;
  if (!distance.known) return result;
  result.known = true;
  result.distance_mm = distance.value;
  result.spacing_mm = brick.spacing_mm;
  result.proved_mm = distance.value - place.error_mm;
  result.gradient = distance.slope / brick.spacing_mm;
  const auto [u, v, w] = place.share;
  result.element = brick.nearest[place.first + (u > 0.5 ? 1 : 0) + (v > 0.5 ? place.row : 0) + (w > 0.5 ? place.layer : 0)];
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

double proved_still_mm(const HapticField& field, const Eigen::Vector3d& at_mm) {
  for (const HapticBrick* brick : {&field.fine, &field.coarse}) {
    if (!covers(*brick, at_mm)) continue;
    const CellPlace place(*brick, at_mm);
    const TrilinearValue distance = trilinear(brick->still_mm, place);
    return distance.known ? distance.value - place.error_mm : -1;
  }
  return -1;
}

MovedNearest nearest_moved(const HapticField& field, const Eigen::Vector3d& at_mm, double part) {
  MovedNearest result;
  const HapticBrick& brick = field.fine;
  if (!covers(brick, at_mm)) return result;
  std::int32_t bucket = 0;
  for (int axis = 2; axis >= 0; --axis) {
    const double along = (at_mm[axis] - brick.origin_mm[axis]) / (brick.spacing_mm * (brick.count[axis] - 1));
    bucket = bucket * kBucketSide + std::clamp(static_cast<std::int32_t>(along * kBucketSide), 0, kBucketSide - 1);
  }
  const std::uint32_t begin = field.bucket_begin[bucket], end = field.bucket_begin[bucket + 1];
  if (begin > end || end > static_cast<std::uint32_t>(kMaxBucketEntries) || end - begin > kMaxTrianglesRead) return result;
  double best_mm = field.moved_reach_mm;
  for (std::uint32_t i = begin; i < end; ++i) {
    const std::uint16_t index = field.bucket_entry[i];
    if (index >= field.moved_count) return result;
    const MovedTriangle& triangle = field.moved[index];
    const Eigen::Vector3d first = corner_at(triangle, 0, part);
    // Most triangles of a bucket are too far away; for what isn't a number this is false.
    if ((first - at_mm).norm() - triangle.radius_mm >= best_mm) continue;
    const Eigen::Vector3d second = corner_at(triangle, 1, part), third = corner_at(triangle, 2, part);
    if (!(first + second + third).allFinite() || !(triangle.radius_mm >= 0)) return result;
    const Eigen::Vector3d point = nearest_of_triangle(at_mm, first, second, third);
    const double distance_mm = (point - at_mm).norm();
    if (distance_mm >= best_mm) continue;
    best_mm = distance_mm;
    result.point_mm = point;
  }
  result.known = true;
  result.distance_mm = best_mm;
  return result;
}

}  // namespace prismesh::drivers::haptics

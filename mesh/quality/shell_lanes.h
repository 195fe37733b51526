// Batches of shells of one shape, lane by lane, as vector code needs them. For mesh/quality, mesh/relax and mesh/repair.
#pragma once

#include <cstddef>
#include <cstdint>

#include "mesh/quality/metrics.h"

namespace prismesh::mesh::quality {

inline constexpr std::size_t kLanes = 64;

/// Corner coordinates of up to kLanes shells of one shape.
struct ShellBatch {
  alignas(64) double p[4][3][kLanes];  ///< [corner][axis][lane]; a triangle's fourth corner is unused
  std::uint32_t slot[kLanes];          ///< the caller's number of the lane's shell
  std::size_t count = 0;

  /// Number of lanes that are computed: the used ones and unused ones up to a multiple of 8.
  std::size_t padded() const { return (count + 7) / 8 * 8; }
};

/// Values that mark defects: a shell that isn't finite has only NaN, one with two corners at one point has exactly this aspect, one without
/// area exactly this skew; no other shell has these.
inline constexpr float kRepeatedAspect = 1e9F;
inline constexpr float kNoAreaSkew = 90.0F;

/// Of the longest edge squared: a shell with less than this as twice its area has no area.
inline constexpr double kMinArea = 1e-10;

/// Metrics lane by lane, indexed by Metric; those that don't apply are NaN.
struct BatchValues {
  alignas(64) float value[kMetricCount][kLanes];
  bool of_triangles = false;

  Values at(std::size_t lane) const {
    Values values;
    for (int m = 0; m < kMetricCount; ++m) values[m] = value[m][lane];
    return values;
  }
};

/// Data for mass and time step, lane by lane.
struct BatchExtents {
  alignas(64) double area[kLanes];         ///< of the two triangles that p0 p2 cuts a quad into
  alignas(64) double moment[3][kLanes];    ///< area times position of its centre
  alignas(64) double step_length[kLanes];  ///< characteristic_length(), mesh/quality/time_step.h
};

/// A batch with one shell's values in its first lane. A shell without values counts as a triangle: it has a defect in any case.
inline BatchValues batch_of(const Values& values) {
  BatchValues batch;
  for (int m = 0; m < kMetricCount; ++m) batch.value[m][0] = values[m];
  const float warpage = values[int(Metric::warpage)];
  batch.of_triangles = !(warpage == warpage);  // it applies to quads only
  return batch;
}

}  // namespace prismesh::mesh::quality

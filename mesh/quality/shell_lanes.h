// Batches of shells of one shape, lane by lane, as vector code needs them. Inner to quality.
#pragma once

#include <cstddef>
#include <cstdint>

#include "mesh/quality/metrics.h"

namespace prismesh::mesh::quality {

inline constexpr std::size_t kLanes = 64;

/// Corner coordinates of up to kLanes shells of one shape.
struct ShellBatch {
  alignas(64) double p[4][3][kLanes];  ///< [corner][axis][lane]; a triangle's fourth corner is unused
  std::uint32_t slot[kLanes];          ///< what the lane's shell is to the caller
  std::size_t count = 0;

  /// The lanes that are computed: the used ones, and spare ones up to a whole number of vectors.
  std::size_t padded() const { return (count + 7) / 8 * 8; }
};

/// What defects do to the values, so that they can be told from them: a shell that isn't finite has none, one with corners at one
/// place has exactly this aspect, one without area exactly this skew, and no other shell has.
inline constexpr float kRepeatedAspect = 1e9F;
inline constexpr float kNoAreaSkew = 90.0F;

/// Of the longest edge squared: with twice its area below that, a shell has none.
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

/// What mass and time step follow from, lane by lane.
struct BatchExtents {
  alignas(64) double area[kLanes];         ///< of the two triangles that p0 p2 cuts a quad into
  alignas(64) double moment[3][kLanes];    ///< area times place
  alignas(64) double step_length[kLanes];  ///< characteristic_length(), mesh/quality/time_step.h
};

/// One shell's values in the first lane, as they came from there. A shell without any counts as a triangle:
/// it has a defect anyhow.
inline BatchValues batch_of(const Values& values) {
  BatchValues batch;
  for (int m = 0; m < kMetricCount; ++m) batch.value[m][0] = values[m];
  const float warpage = values[int(Metric::warpage)];
  batch.of_triangles = !(warpage == warpage);  // it applies to quads only
  return batch;
}

}  // namespace prismesh::mesh::quality

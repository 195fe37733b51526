// Criteria for one target size, as plain limits.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "mesh/quality/criteria.h"
#include "mesh/quality/sheet.h"
#include "mesh/quality/shell_lanes.h"

namespace prismesh::mesh::quality {

inline constexpr int kMinLength = int(Metric::min_length);

/// One end of a metric's range on the scale of the composite: (value - limit) * per is 0 at the fail limit and 1 where it is ideal.
struct Side {
  float limit = std::numeric_limits<float>::quiet_NaN();  ///< NaN: no fail limit
  float per = 0;
};

/// Criteria for one target size, as plain limits of one shape's metrics.
struct ShapeLimits {
  std::array<Threshold, kMetricCount> threshold;
  std::array<std::array<Side, 2>, kMetricCount> side;
  float ideal_min_length = 0;
};
struct Limits {
  ShapeLimits quad, triangle;
  float warn_thicknesses = 0;
  float fail_thicknesses = 0;
  float warn_step = 0;  ///< least min_length for a wave speed of 1
  float fail_step = 0;

  const ShapeLimits& of(bool of_triangles) const { return of_triangles ? triangle : quad; }
  bool need_sheets() const { return warn_thicknesses > 0 || fail_thicknesses > 0 || warn_step > 0 || fail_step > 0; }
};
/// Lengths in the unit of `target_size`.
Limits limits_for(const SizedCriteria& criteria);

/// The least min_length a lane may have, where the criteria look at sheets.
struct MinLengths {
  float warn[kLanes];
  float fail[kLanes];
};
void min_lengths(const ShapeLimits& shape, const Limits& limits, std::span<const Sheet> sheets, MinLengths& out);

/// What judge() compares a value of the metric with, in the metric's unit: lengths follow the target size, the least min_length also what
/// the criteria ask for by the shell's thickness and by a wanted time step. `sheet` as in judge().
Threshold threshold_of(const SizedCriteria& criteria, Metric metric, bool of_triangle, const Sheet& sheet = {});

/// How far it is from a limit to the ideal; where a file's limit leaves no way, a twentieth of it.
inline float span_of(float limit, float best) { return std::max(std::abs(best - limit), std::max(0.05F * std::abs(limit), 1e-30F)); }

}  // namespace prismesh::mesh::quality

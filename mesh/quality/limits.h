// Criteria with their target sizes, as limits ready to compare with.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "mesh/quality/criteria.h"
#include "mesh/quality/shell_lanes.h"
#include "mesh/quality/shell_properties.h"

namespace prismesh::mesh::quality {

inline constexpr int kMinLength = int(Metric::min_length);

/// One end of a metric's range on the scale of the composite: (value - limit) * slope is 0 at the fail limit and 1 at the ideal value.
struct ScoreSide {
  float limit = std::numeric_limits<float>::quiet_NaN();  ///< NaN: no fail limit
  float slope = 0;
};

/// Limits of one shape's metrics, indexed by Metric; lengths in the unit of the target size.
struct ShapeLimits {
  std::array<Threshold, kMetricCount> threshold;
  std::array<std::array<ScoreSide, 2>, kMetricCount> side;
  float ideal_min_length = 0;
};
struct Limits {
  ShapeLimits quad, triangle;
  float warn_thicknesses = 0;
  float fail_thicknesses = 0;
  float warn_step = 0;  ///< limit of min_length for a wave speed of 1
  float fail_step = 0;

  const ShapeLimits& of(bool of_triangles) const { return of_triangles ? triangle : quad; }
  /// Whether the limits of min_length depend on a shell's thickness or material.
  bool need_material() const { return warn_thicknesses > 0 || fail_thicknesses > 0 || warn_step > 0 || fail_step > 0; }
};

/// The limits of each part. Parts that are judged alike share theirs.
struct LimitsByPart {
  std::vector<Limits> distinct;                ///< the first: of shells that belong to no part
  std::span<const std::uint32_t> part_limits;  ///< by PartIndex: index into `distinct` less one; empty: all by the first
  bool needs_material = false;

  std::uint32_t index_of(PartIndex part) const { return part.value < part_limits.size() ? part_limits[part.value] + 1 : 0; }
  const Limits& of(PartIndex part) const { return distinct[index_of(part)]; }
  /// Whether shells are judged by their parts, so that ShellProperties::part is needed.
  bool need_part() const { return !part_limits.empty(); }
  bool need_properties() const { return needs_material || need_part(); }
};
/// The criteria as limits; lengths in the unit of the target size. The limits refer to the criteria's list of parts.
LimitsByPart limits_for(const SizedCriteria& criteria);
/// The limits of shells that belong to no part.
Limits limits_without_part(const SizedCriteria& criteria);

/// The limits of min_length of each lane, where they depend on the shell's thickness or material.
struct MinLengths {
  float warn[kLanes];
  float fail[kLanes];
};
void min_lengths(const ShapeLimits& shape, const Limits& limits, std::span<const ShellProperties> properties, MinLengths& out);

/// The limits that judge() compares a value of the metric with, in the metric's unit: lengths follow the target size; those of min_length
/// also follow the shell's thickness and a wanted time step. `properties`: as in judge(); their part tells which criteria count.
Threshold threshold_of(const SizedCriteria& criteria, Metric metric, bool of_triangle, const ShellProperties& properties = {});

/// The distance from a limit to the ideal value; at least a twentieth of the limit.
inline float span_of(float limit, float best) { return std::max(std::abs(best - limit), std::max(0.05F * std::abs(limit), 1e-30F)); }

}  // namespace prismesh::mesh::quality

// Shell element metrics: names, units and values. Definitions and sources: docs/quality/metrics.md.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace prismesh::mesh::quality {

enum class Metric : std::uint8_t {
  warpage,   ///< degrees
  aspect,    ///< longest / shortest edge
  skew,      ///< degrees
  jacobian,  ///< min / max determinant at the 2x2 Gauss points
  taper,
  min_angle_quad,  ///< degrees
  max_angle_quad,
  min_angle_tri,
  max_angle_tri,
  min_length,  ///< deck's length unit; triangle: smallest height
  max_length,
};
inline constexpr int kMetricCount = 11;
std::string_view name(Metric metric);                                   ///< as in the command line's JSON
std::string_view unit_of(Metric metric, std::string_view length_unit);  ///< "deg", the length unit, or none for a ratio
bool is_of_triangles(Metric metric);                                    ///< quads have no such value

/// One shell's values, indexed by Metric; NaN where the metric doesn't apply to the shape.
using Values = std::array<float, kMetricCount>;

}  // namespace prismesh::mesh::quality

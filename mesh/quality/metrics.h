// Shell element metrics, all in one pass. Definitions: docs/quality/metrics.md; source: the table there and the Verdict manual, whose
// own versions of aspect, skew and Jacobian differ and are not used here.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "mesh/model/model.h"

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

/// Metrics of one shell from its corner coordinates (3 or 4 points). Degenerate shapes give the worst value; where a coordinate is no
/// finite number all values are NaN.
Values measure(std::span<const Vec3> corners);

/// Metrics of shells [begin, end) or of the listed shells; `out` has one entry each, NaN throughout for a removed shell.
void measure_range(const Model& model, std::size_t begin, std::size_t end, std::span<Values> out);
void measure_shells(const Model& model, std::span<const ShellIndex> shells, std::span<Values> out);

}  // namespace prismesh::mesh::quality

// Measures shell elements, all metrics in one pass. Definitions: docs/quality/metrics.md; source: the table there and the Verdict manual,
// whose own versions of aspect, skew and Jacobian differ and are not used here.
#pragma once

#include <span>

#include "mesh/model/model.h"
#include "mesh/quality/metrics.h"

namespace prismesh::mesh::quality {

/// Metrics of one shell from its corner coordinates (3 or 4 points). Degenerate shapes give the worst value; where a coordinate is no
/// finite number all values are NaN.
Values measure(std::span<const Vec3> corners);

/// Metrics of shells [begin, end) or of the listed shells; `out` has one entry each, NaN throughout for a removed shell.
void measure_range(const Model& model, std::size_t begin, std::size_t end, std::span<Values> out);
void measure_shells(const Model& model, std::span<const ShellIndex> shells, std::span<Values> out);

}  // namespace prismesh::mesh::quality

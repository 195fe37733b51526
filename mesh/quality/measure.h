// Measures shell elements, all metrics in one pass. Definitions: docs/quality/metrics.md; source: the table there and the Verdict manual,
// whose own versions of aspect, skew and Jacobian differ and are not used here.
#pragma once

#include <span>

#include "mesh/model/model.h"
#include "mesh/quality/metrics.h"

namespace prismesh::mesh::quality {

/// Measures one shell from its corners (3 or 4 points). Degenerate shapes give the worst value; all values are NaN if a coordinate isn't
/// finite.
Values measure(std::span<const Vec3> corners);

/// Measures shells [begin, end) or the listed shells; `out` has an entry for each, all NaN for a removed shell.
void measure_range(const Model& model, std::size_t begin, std::size_t end, std::span<Values> out);
void measure_shells(const Model& model, std::span<const ShellIndex> shells, std::span<Values> out);

}  // namespace prismesh::mesh::quality

// Draws a histogram as a picture in a page.
#pragma once

#include <optional>
#include <string>

#include "mesh/quality/criteria.h"
#include "mesh/report/histogram.h"

namespace prismesh::mesh::report {

/// An <svg> element: the shells before as bars, those after as an outline, the limits as lines. Heights grow with the square root of the
/// count, so that a few bad shells can be seen. `limits`: of the metric in its unit; absent where shells have different ones.
std::string histogram_svg(const Histogram& histogram, const std::optional<quality::Threshold>& limits, const std::string& unit);

}  // namespace prismesh::mesh::report

// Draws a small line chart as an SVG file.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace prismesh::phase_error {

struct Curve {
  std::string name;
  std::string colour;  ///< in SVG's notation: "#0072b2"
  std::vector<std::array<double, 2>> points;
};

/// Axes from 0 to `right` and from 0 to `top`.
struct Plot {
  std::string title, across, up;
  double right = 1, top = 1;
  double limit = 0;  ///< a dashed line at this height
  std::vector<Curve> curves;
};
std::string svg(const Plot& plot);

}  // namespace prismesh::phase_error

#include "mesh/batch/scatter.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "base/readable_number.h"
#include "mesh/batch/columns.h"
#include "mesh/report/html.h"

namespace prismesh::mesh::batch {

namespace {

using report::html_text;

constexpr std::size_t kParametersDrawn = 6;
constexpr std::size_t kPointsDrawn = 1000;
constexpr double kWidth = 250, kHeight = 150, kLeft = 62, kRight = 8, kTop = 18, kBottom = 22;

using Points = std::vector<std::pair<double, double>>;

Points points_of(const Table& table, std::size_t parameter, const Column& column) {
  Points points;
  for (const Row& row : table.rows) {
    const double* x = std::get_if<double>(&row.values[parameter]);
    const std::optional<double> y = figure_of(column, row);
    if (x != nullptr && y && std::isfinite(*y)) points.emplace_back(*x, *y);
  }
  if (points.size() <= kPointsDrawn) return points;
  Points some;
  for (std::size_t i = 0; i < kPointsDrawn; ++i) some.push_back(points[i * points.size() / kPointsDrawn]);
  return some;
}

bool is_constant(const Points& points) {
  return std::all_of(points.begin(), points.end(), [&](const auto& point) { return point.second == points.front().second; });
}

std::string at(double value) { return readable(std::round(value * 10) / 10, 6); }
/// At most four digits, in few characters.
std::string short_number(double value) {
  if (value == 0 || std::abs(value) >= 1e-3) return readable(value, 4);
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}
std::string label(double x, double y, const char* anchor, const std::string& text) {
  return "<text x=\"" + at(x) + "\" y=\"" + at(y) + "\" text-anchor=\"" + anchor + "\">" + html_text(text) + "</text>";
}

/// The range of values, with some room where they are all the same.
std::pair<double, double> range(double low, double high) {
  if (high > low) return {low, high};
  const double half = std::max(1e-12, 0.05 * std::abs(low));
  return {low - half, high + half};
}

std::string scatter(const Points& points) {
  const auto [x_low, x_high] = std::minmax_element(points.begin(), points.end());
  const auto by_y = [](const auto& one, const auto& other) { return one.second < other.second; };
  const auto [y_low, y_high] = std::minmax_element(points.begin(), points.end(), by_y);
  const auto xs = range(x_low->first, x_high->first), ys = range(y_low->second, y_high->second);
  const double ground = kHeight - kBottom;
  std::string out = "<svg viewBox=\"0 0 " + at(kWidth) + " " + at(kHeight) +
                    "\" role=\"img\"><path fill=\"none\" stroke=\"#d5dae0\" d=\"M" + at(kLeft) + " " + at(kTop) + "V" + at(ground) + "H" +
                    at(kWidth - kRight) + "\"/><g fill=\"#1668b0\" fill-opacity=\".55\">";
  for (const auto& [x, y] : points)
    out += "<circle r=\"3\" cx=\"" + at(kLeft + 4 + (x - xs.first) / (xs.second - xs.first) * (kWidth - kLeft - kRight - 8)) + "\" cy=\"" +
           at(ground - 4 - (y - ys.first) / (ys.second - ys.first) * (ground - kTop - 8)) + "\"/>";
  out += "</g>" + label(kLeft - 5, kTop + 8, "end", short_number(y_high->second)) +
         label(kLeft - 5, ground, "end", short_number(y_low->second));
  out += label(kLeft, kHeight - 6, "start", short_number(x_low->first)) +
         label(kWidth - kRight, kHeight - 6, "end", short_number(x_high->first));
  return out + "</svg>";
}

}  // namespace

std::string scatter_section(const Table& table) {
  std::string out;
  for (std::size_t parameter = 0; parameter < std::min(table.parameters.size(), kParametersDrawn); ++parameter) {
    std::string charts;
    for (const Column& column : columns()) {
      if (!column.is_drawn) continue;
      const Points points = points_of(table, parameter, column);
      if (points.size() < 2 || is_constant(points)) continue;
      charts += "<figure><h3>" + html_text(column.words) + " over " + html_text(table.parameters[parameter]) + "</h3>" + scatter(points) +
                "</figure>\n";
    }
    if (!charts.empty())
      out += "<div class=\"charts\" style=\"grid-template-columns:repeat(auto-fill,minmax(230px,1fr))\">\n" + charts + "</div>\n";
  }
  return out.empty()
             ? out
             : "<h2>How figures depend on parameters</h2>\n<p class=\"soft\">A point is a variant. What is the same in all variants has no "
               "picture.</p>\n" +
                   out;
}

}  // namespace prismesh::mesh::batch

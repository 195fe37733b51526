#include "tests/phase_error/plot.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>

namespace prismesh::phase_error {
namespace {

constexpr double kWidth = 900, kHeight = 320, kLeft = 64, kRight = 16, kTop = 40, kBottom = 44;

[[gnu::format(printf, 2, 3)]] void add(std::string& to, const char* format, ...) {
  char line[512];
  std::va_list values;
  va_start(values, format);
  std::vsnprintf(line, sizeof line, format, values);
  va_end(values);
  to += line;
}

double x_of(const Plot& plot, double value) { return kLeft + value / plot.right * (kWidth - kLeft - kRight); }
double y_of(const Plot& plot, double value) { return kHeight - kBottom - std::min(1.0, value / plot.top) * (kHeight - kTop - kBottom); }

void add_grid(std::string& to, const Plot& plot) {
  constexpr int kSteps = 4;
  for (int i = 0; i <= kSteps; ++i) {
    const double across = plot.right * i / kSteps, up = plot.top * i / kSteps, x = x_of(plot, across), y = y_of(plot, up);
    add(to, "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"#ddd\"/>\n", kLeft, y, kWidth - kRight, y);
    add(to, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">%.3g</text>\n", kLeft - 8, y + 4, up);
    add(to, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">%.3g</text>\n", x, kHeight - kBottom + 18, across);
  }
  const double y = y_of(plot, plot.limit);
  add(to, "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"#555\" stroke-dasharray=\"6 4\"/>\n", kLeft, y, kWidth - kRight,
      y);
}

}  // namespace

std::string svg(const Plot& plot) {
  std::string to;
  add(to, "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" font-family=\"DejaVu Sans, sans-serif\" font-size=\"12\">\n",
      kWidth, kHeight);
  add(to, "<rect width=\"%.0f\" height=\"%.0f\" fill=\"#fff\"/>\n<text x=\"%.0f\" y=\"20\" font-size=\"14\">%s</text>\n", kWidth, kHeight,
      kLeft, plot.title.c_str());
  add_grid(to, plot);
  add(to, "<text x=\"%.0f\" y=\"%.0f\" text-anchor=\"middle\">%s</text>\n", (kWidth + kLeft) / 2, kHeight - 8, plot.across.c_str());
  add(to, "<text x=\"16\" y=\"%.0f\" text-anchor=\"middle\" transform=\"rotate(-90 16 %.0f)\">%s</text>\n", kHeight / 2, kHeight / 2,
      plot.up.c_str());
  double legend_x = kWidth - kRight - 110.0 * static_cast<double>(plot.curves.size());
  for (const Curve& curve : plot.curves) {
    add(to, "<polyline fill=\"none\" stroke=\"%s\" stroke-width=\"1.5\" points=\"", curve.colour.c_str());
    for (const auto& point : curve.points)
      if (point[0] <= plot.right) add(to, "%.1f,%.1f ", x_of(plot, point[0]), y_of(plot, point[1]));
    add(to, "\"/>\n<text x=\"%.0f\" y=\"36\" fill=\"%s\">%s</text>\n", legend_x, curve.colour.c_str(), curve.name.c_str());
    legend_x += 110;
  }
  to += "</svg>\n";
  return to;
}

}  // namespace prismesh::phase_error

#include "mesh/report/histogram_svg.h"

#include <algorithm>
#include <cmath>

#include "base/readable_number.h"
#include "mesh/report/html.h"

namespace prismesh::mesh::report {

namespace {

constexpr double kWidth = 340, kHeight = 130, kLeft = 4, kRight = 4, kTop = 16, kBottom = 20;
constexpr double kBin = (kWidth - kLeft - kRight) / static_cast<double>(kHistogramBins);

/// Coordinates with a tenth of a pixel.
std::string at(double value) { return readable(std::round(value * 10) / 10, 6); }

std::string text_at(double x, double y, const char* anchor, const std::string& text) {
  return "<text x=\"" + at(x) + "\" y=\"" + at(y) + "\" text-anchor=\"" + anchor + "\">" + html_text(text) + "</text>";
}

double height_of(std::size_t count, std::size_t most) {
  return most == 0 ? 0 : std::sqrt(static_cast<double>(count) / static_cast<double>(most)) * (kHeight - kTop - kBottom);
}

std::string bars(const Histogram& histogram, std::size_t most) {
  std::string out = "<path fill=\"#b9c1c9\" d=\"";
  const double ground = kHeight - kBottom;
  for (std::size_t bin = 0; bin < kHistogramBins; ++bin) {
    if (histogram.before[bin] == 0) continue;
    const double height = std::max(1.0, height_of(histogram.before[bin], most));
    out +=
        "M" + at(kLeft + kBin * static_cast<double>(bin)) + " " + at(ground) + "v" + at(-height) + "h" + at(kBin) + "v" + at(height) + "z";
  }
  return out + "\"/>";
}

std::string outline(const Histogram& histogram, std::size_t most) {
  const double ground = kHeight - kBottom;
  std::string out = "<path fill=\"none\" stroke=\"#1668b0\" stroke-width=\"1.6\" d=\"M" + at(kLeft) + " " + at(ground);
  for (std::size_t bin = 0; bin < kHistogramBins; ++bin) {
    const double height = histogram.after[bin] == 0 ? 0 : std::max(1.0, height_of(histogram.after[bin], most));
    out += "V" + at(ground - height) + "H" + at(kLeft + kBin * static_cast<double>(bin + 1));
  }
  return out + "V" + at(ground) + "\"/>";
}

std::string limit(const Histogram& histogram, float value, const char* colour, const char* dashes) {
  if (!std::isfinite(value) || value < histogram.low || value > histogram.high) return "";
  const double x = kLeft + (value - histogram.low) / (histogram.high - histogram.low) * (kWidth - kLeft - kRight);
  return "<path fill=\"none\" stroke=\"" + std::string(colour) + "\" stroke-width=\"1.4\" stroke-dasharray=\"" + dashes + "\" d=\"M" +
         at(x) + " " + at(kTop) + "V" + at(kHeight - kBottom) + "\"/>";
}

}  // namespace

std::string histogram_svg(const Histogram& histogram, const std::optional<quality::Threshold>& limits, const std::string& unit) {
  std::size_t most = 0;
  for (std::size_t bin = 0; bin < kHistogramBins; ++bin) most = std::max({most, histogram.before[bin], histogram.after[bin]});
  const double ground = kHeight - kBottom;
  std::string out = "<svg viewBox=\"0 0 " + at(kWidth) + " " + at(kHeight) + "\" role=\"img\" aria-label=\"" +
                    html_text(name(histogram.metric)) + "\">" + bars(histogram, most) + outline(histogram, most);
  if (limits) {
    for (const float value : {limits->warn_low, limits->warn_high}) out += limit(histogram, value, "#c98a00", "4 3");
    for (const float value : {limits->fail_low, limits->fail_high}) out += limit(histogram, value, "#b3261e", "none");
  }
  out += "<path stroke=\"#8b97a3\" d=\"M" + at(kLeft) + " " + at(ground) + "H" + at(kWidth - kRight) + "\"/>";
  const std::string of_unit = unit.empty() ? "" : " " + unit;
  out += text_at(kLeft, kHeight - 6, "start", (histogram.more_below ? "\u2264 " : "") + readable(histogram.low, 4));
  out += text_at(kWidth - kRight, kHeight - 6, "end", (histogram.more_above ? "\u2265 " : "") + readable(histogram.high, 4) + of_unit);
  out += text_at(kLeft, 11, "start", std::to_string(most) + " shells");
  return out + "</svg>";
}

}  // namespace prismesh::mesh::report

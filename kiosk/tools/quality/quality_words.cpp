#include "kiosk/tools/quality/quality_words.h"

#include <cmath>

#include <fmt/format.h>

#include "base/readable_number.h"
#include "kiosk/panels/text.h"

namespace prismesh::kiosk::tools::quality {

using panels::metric_words;

std::string value_words(double value, const std::string& unit) {
  const std::string number = std::abs(value) >= 1e6 ? fmt::format("{:.1e}", value) : readable(value, 4);
  return unit.empty() ? number : unit == "deg" ? number + "\u00b0" : number + " " + unit;
}

namespace {

constexpr const char* kManyTriangles = "many triangles together";

}  // namespace

std::string error_words(const ipc::QualityError& error) {
  if (error.node != 0) return fmt::format("node {}: {}, {} about it", error.node, kManyTriangles, value_words(error.value.value_or(0), {}));
  std::string words = fmt::format("shell {}: {}", error.shell, metric_words(error.metric));
  if (error.value) words += fmt::format(" {} {}", value_words(*error.value, error.unit), error.fail ? "fails" : "warns");
  return words;
}

std::string error_row_words(const ipc::QualityError& error) {
  if (error.node != 0) return fmt::format("node {}  {} triangles together", error.node, value_words(error.value.value_or(0), {}));
  std::string words = fmt::format("{}  {}", error.shell, metric_words(error.metric));
  if (error.value) words += "  " + value_words(*error.value, error.unit);
  return words;
}

std::string kind_words(const std::string& metric) { return metric == "triangle_clusters" ? kManyTriangles : metric_words(metric); }

}  // namespace prismesh::kiosk::tools::quality

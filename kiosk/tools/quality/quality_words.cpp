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

std::string error_words(const ipc::QualityError& error) {
  std::string words = fmt::format("shell {}: {}", error.shell, metric_words(error.metric));
  if (error.value) words += fmt::format(" {} {}", value_words(*error.value, error.unit), error.fail ? "fails" : "warns");
  return words;
}

}  // namespace prismesh::kiosk::tools::quality

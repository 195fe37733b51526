// Facts for the quality panel, and what the user asks for there.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "ipc/messages.h"
#include "kiosk/tools/quality/mend_limits.h"
#include "mesh/document/edit.h"

namespace prismesh::kiosk::tools::quality {

struct QualityFacts {
  const ipc::Quality* figures = nullptr;  ///< null: not here yet
  bool stale = false;                     ///< of an older generation; newer figures are requested
  std::string metric;                     ///< the chosen metric; empty: all
  bool damaged = false;
  std::optional<std::size_t> error;  ///< the error that the view went to
  MendLimits limits{};
  std::string length_unit;
};

struct ChooseMetric {
  std::string metric;
};
struct BarClicked {
  ipc::QualityBar bar;
  mesh::document::SelectMode mode = mesh::document::SelectMode::set;
};
struct ErrorClicked {
  std::size_t error = 0;
};

using QualityAction = std::variant<ChooseMetric, BarClicked, ErrorClicked>;
using QualityActions = std::vector<QualityAction>;

}  // namespace prismesh::kiosk::tools::quality

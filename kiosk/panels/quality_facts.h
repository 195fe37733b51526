// What the quality panel shows, and what may be asked of it.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "ipc/messages.h"
#include "mesh/document/edit.h"

namespace prismesh::kiosk::panels {

struct QualityFacts {
  const ipc::Quality* figures = nullptr;  ///< null: not here yet
  bool stale = false;                     ///< of an older generation; newer ones are on their way
  std::string metric;                     ///< that is looked at; empty: all
  bool damaged = false;
  std::optional<std::size_t> error;  ///< which of the errors is gone to
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

/// "min angle quad".
std::string metric_words(const std::string& name);
/// "17.3°", "0.42 mm", "4.1".
std::string value_words(double value, const std::string& unit);
/// "shell 12: warpage 17.3° fails", "shell 12: no area".
std::string error_words(const ipc::QualityError& error);

}  // namespace prismesh::kiosk::panels

// Facts for the quality panel, and what the user asks for there.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "ipc/model/messages.h"
#include "kiosk/tools/quality/criteria_facts.h"
#include "kiosk/tools/quality/mend_limits.h"
#include "mesh/document/edit.h"

namespace prismesh::kiosk::tools::quality {

/// The target sizes of the parts with shells.
struct SizeFacts {
  double min = 0, max = 0;
  std::string unit;
  bool of_selection = false;  ///< something is selected: a new size applies to the selection's parts, else to all
};

struct QualityFacts {
  const ipc::Quality* figures = nullptr;  ///< null: not here yet
  bool stale = false;                     ///< of an older generation; newer figures are requested
  std::string metric;                     ///< the chosen metric; empty: all
  bool damaged = false;                   ///< figures and errors are only of what edits made worse
  std::string glyphs;                     ///< which are shown, in words
  std::optional<std::size_t> error;       ///< the error that the view went to
  MendLimits limits{};
  std::string length_unit;
  std::optional<SizeFacts> sizes;
  std::optional<CriteriaFacts> criteria;
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

struct SizeChosen {
  mesh::document::TargetSize size;
};

/// The list of criteria was opened: it needs the files beside the deck.
struct CriteriaListed {};
struct CriteriaChosen {
  std::string criteria;  ///< as SetCriteria takes it
};

using QualityAction = std::variant<ChooseMetric, BarClicked, ErrorClicked, SizeChosen, CriteriaListed, CriteriaChosen>;
using QualityActions = std::vector<QualityAction>;

}  // namespace prismesh::kiosk::tools::quality

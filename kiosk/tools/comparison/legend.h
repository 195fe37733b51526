// The legend: what the colours of a field mean.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kiosk/panels/panel_layout.h"
#include "kiosk/tools/comparison/legend_facts.h"

namespace prismesh::kiosk::tools::comparison {

/// The value that is farthest toward the map's end, and where: "most 3.1 at node:12", "least .." where small values are coloured, or
/// "0 everywhere".
std::string worst_words(const LegendFacts& facts);
/// What the colours don't show, a sentence each.
std::vector<std::string> legend_notes(const LegendFacts& facts);

struct DrawnLegend {
  std::optional<SetLimits> wanted;  ///< new limits, if they were dragged or typed
  float top = 0;                    ///< its upper edge, pixels
};

/// Lays it out at the bottom of the picture (inside Gui::layout).
DrawnLegend legend(const LegendFacts& facts, const panels::PanelLayout& layout);

}  // namespace prismesh::kiosk::tools::comparison

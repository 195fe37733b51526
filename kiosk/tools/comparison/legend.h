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
/// The value under the pointer: "node 12: 3.1 mm", "shell 7: no value"; empty: nothing is under the pointer.
std::string probe_words(const LegendFacts& facts);
/// Limits that spread the map over all values; empty: they are all the same.
std::optional<SetLimits> limits_of_values(const LegendFacts& facts);
/// Round numbers between the limits, three to eight of them, from `clear` to `full`.
std::vector<double> ticks(const render::FieldLook& look);
/// What the colours don't show, a sentence each.
std::vector<std::string> legend_notes(const LegendFacts& facts);

struct DrawnLegend {
  std::optional<SetLimits> wanted;  ///< new limits, if they were dragged, typed, or taken from the values
  float top = 0;                    ///< its upper edge, pixels
};

/// Lays it out at the bottom of the picture (inside Gui::layout).
DrawnLegend legend(const LegendFacts& facts, panels::PanelLayout& layout);

}  // namespace prismesh::kiosk::tools::comparison

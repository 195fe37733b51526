// The panel that sets how pulls fade out, and the words that say how far something is pulled.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "kiosk/panels/panel_layout.h"
#include "kiosk/tools/shaping/shaping_options.h"

namespace prismesh::kiosk::tools::shaping {

struct ShapingFacts {
  ShapingOptions options;
  std::string length_unit;
  input::Under handle = input::Under::lift_handle;  ///< which part of the handle a typed number pulls
};
/// Lays the panel out (inside Gui::layout). Returns other options, if the user chose some beside commands.
std::optional<ShapingOptions> shaping_panel(const ShapingFacts& facts, panels::PanelLayout& layout);

struct PullFacts {
  std::string what;  ///< "Lift", "Slide", "Move", "Turn"
  double length = 0;
  std::string length_unit;
  std::optional<double> degrees{};  ///< in place of a length
  std::uint64_t nodes = 0;          ///< that move
};
/// "12.4 mm", "3.20\u00b0".
std::string pull_value(const PullFacts& facts);
/// "Lift 12.4 mm   416 nodes move".
std::string pull_words(const PullFacts& facts);

}  // namespace prismesh::kiosk::tools::shaping

// The panel of the calibration: what to do, which value is being adjusted, and the buttons for it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kiosk/display/window.h"

namespace prismesh::kiosk::panels {

struct WizardFacts {
  int number = 1, count = 1;  ///< of this step, of all
  std::string title;
  std::string task;
  std::string value;  ///< empty: this step adjusts nothing
  std::vector<std::string> remarks;
  std::string trouble;  ///< why the wizard didn't go on
  std::string next;
  bool first = false;
};

enum class WizardAction : std::uint8_t { less, more, much_less, much_more, back, next, leave };

/// Lays the panel out in the lower half of the picture (inside Gui::layout).
std::vector<WizardAction> wizard_panel(const WizardFacts& facts, display::PixelSize picture);

}  // namespace prismesh::kiosk::panels

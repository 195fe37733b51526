// The pages of a station's set-up, for fingers, mouse and keyboard: choices, fields, and the keys to type into them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "kiosk/panels/panel_layout.h"
#include "kiosk/setup/guide.h"

namespace prismesh::kiosk::setup {

struct SetupAction {
  enum class Kind : std::uint8_t { choose, focus, type, erase, next, skip, back, leave, calibrate };
  Kind kind = Kind::next;
  std::size_t number = 0;  ///< of a choice or a field
  std::string text{};      ///< that is typed
};

/// Lays a page out over the whole picture (inside Gui::layout). `works`: what was asked isn't done yet, and nothing can be pressed.
std::vector<SetupAction> setup_panel(const View& view, bool works, panels::PanelLayout& layout);

}  // namespace prismesh::kiosk::setup

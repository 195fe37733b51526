// The list of the deck's warnings: a place and a sentence each.
#pragma once

#include <span>
#include <string>

#include "kiosk/display/window.h"
#include "kiosk/notices/deck_warnings.h"

namespace prismesh::kiosk::panels {

/// Lays the list out (inside Gui::layout). `deck`: its path.
void warnings_panel(std::span<const notices::ToldWarning> warnings, const std::string& deck, display::PixelSize picture);

}  // namespace prismesh::kiosk::panels

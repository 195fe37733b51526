// The list of the deck's warnings: a place and a sentence each.
#pragma once

#include <span>
#include <string>

#include "kiosk/notices/deck_warnings.h"
#include "kiosk/panels/places.h"

namespace prismesh::kiosk::panels {

/// Lays the list out (inside Gui::layout). `deck`: its path.
void warnings_panel(std::span<const notices::ToldWarning> warnings, const std::string& deck, const Place& room);

}  // namespace prismesh::kiosk::panels

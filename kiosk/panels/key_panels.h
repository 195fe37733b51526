// The panels that list all keys: the help, and the menu.
#pragma once

#include <span>

#include "kiosk/display/window.h"
#include "kiosk/tools/command.h"
#include "kiosk/tools/mouse_layout.h"
#include "kiosk/tools/panel_layout.h"

namespace prismesh::kiosk::panels {

void help_panel(std::span<const tools::KeyBinding> keys, std::span<const tools::MouseBinding> mouse, display::PixelSize picture);
/// All commands in columns, menu by menu; a click does one.
void menu_panel(std::span<const tools::KeyBinding> all, tools::PanelLayout& layout);

}  // namespace prismesh::kiosk::panels

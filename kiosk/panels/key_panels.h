// The panels that list all keys: the help, and the menu.
#pragma once

#include <span>

#include "kiosk/display/window.h"
#include "kiosk/input/command.h"
#include "kiosk/input/mouse_layout.h"
#include "kiosk/panels/panel_layout.h"

namespace prismesh::kiosk::panels {

void help_panel(std::span<const input::KeyBinding> keys, std::span<const input::MouseBinding> mouse, const Place& room);
/// All commands in columns, menu by menu; a click does one.
void menu_panel(std::span<const input::KeyBinding> all, PanelLayout& layout);

}  // namespace prismesh::kiosk::panels

// Settings, hints and boxes that several panels have. For sources that lay panels out: includes ImGui through layout.h.
#pragma once

#include <string>

#include "kiosk/display/window.h"
#include "kiosk/input/command.h"
#include "kiosk/panels/layout.h"
#include "kiosk/panels/panel_layout.h"

namespace prismesh::kiosk::panels {

/// A value, and a button that sets the next one: "falloff ..... smooth".
void setting(const char* label, const std::string& value, const input::KeyBinding& next, PanelLayout& layout);
/// A tooltip over the item before: what the command does, and its key.
void hint(const input::KeyBinding& binding);
/// A box with a tick that a command turns over.
void check(const char* label, bool value, const input::Command& toggle, PanelLayout& layout);
/// Title of a panel, and a line in small type.
void panel_title(const char* title, const char* line);

/// Notes the item before for programs that watch.
void note_item(PanelLayout& layout, std::string name, std::string state);

}  // namespace prismesh::kiosk::panels

// Settings, hints and boxes that several panels have. For sources that lay panels out: includes ImGui through layout.h.
#pragma once

#include <string>

#include "kiosk/display/window.h"
#include "kiosk/panels/layout.h"
#include "kiosk/tools/command.h"
#include "kiosk/tools/panel_layout.h"

namespace prismesh::kiosk::panels {

/// A value, and a button that sets the next one: "falloff ..... smooth".
void setting(const char* label, const std::string& value, const tools::KeyBinding& next, tools::PanelLayout& layout);
/// A tooltip over the item before: what the command does, and its key.
void hint(const tools::KeyBinding& binding);
/// A box with a tick that a command turns over.
void check(const char* label, bool value, const tools::Command& toggle, tools::PanelLayout& layout);
/// Title of a panel at the left, and a line in small type.
void panel_title(const char* title, const char* line);

}  // namespace prismesh::kiosk::panels

// Opens and closes panels: one at the left, one dialog, one cover.
#pragma once

#include "kiosk/toolkit/tool_context.h"

namespace prismesh::kiosk::toolkit {

/// Shows a tool's panel at the left in the place of the one that is there. Null: the document's.
void show_left(ToolContext& context, Tool* tool);
/// Shows it, or the document's if it is shown already.
void toggle_left(ToolContext& context, Tool* tool);

/// Opens a dialog of the tool in the place of the one that is open, and closes what covers the panels.
void open_dialog(ToolContext& context, HasDialogs* owner, int kind = 0);
inline void close_dialog(ToolContext& context) { context.open.dialog = {}; }

/// Shows that in the place of the panels at the sides. The deck's warnings count as read when they are shown.
void set_cover(ToolContext& context, Cover cover);

}  // namespace prismesh::kiosk::toolkit

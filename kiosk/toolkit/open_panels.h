// Takes tools in hand, and opens and closes one dialog and one cover.
#pragma once

#include "kiosk/toolkit/tool_context.h"

namespace prismesh::kiosk::toolkit {

/// Shows a tool's panel and options. Null: those of the usual tool.
void take_in_hand(ToolContext& context, Tool* tool);
/// Takes it in hand, or puts it down if it is.
void toggle_in_hand(ToolContext& context, Tool* tool);

/// Opens a dialog of the tool in the place of the one that is open, and closes what covers the panels.
void open_dialog(ToolContext& context, HasDialogs* owner, int kind = 0);
/// Its owner follows.
inline void close_dialog(ToolContext& context) {
  context.open.dialog = {};
  context.follow_soon = true;
}

/// Shows that over the view. The deck's warnings count as read when they are shown.
void set_cover(ToolContext& context, Cover cover);

}  // namespace prismesh::kiosk::toolkit

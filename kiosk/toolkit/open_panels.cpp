#include "kiosk/toolkit/open_panels.h"

#include <utility>

#include <fmt/format.h>

#include "kiosk/toolkit/tool_set.h"

namespace prismesh::kiosk::toolkit {

void take_in_hand(ToolContext& context, Tool* tool) {
  context.tools.leave_mode();  // no mode acts unseen
  context.open.in_hand = tool;
  context.trace.line("panel " + (tool != nullptr ? std::string(tool->panel_name()) : "document"));
  context.tools.panel_changed();
  context.follow_soon = true;
}

void toggle_in_hand(ToolContext& context, Tool* tool) { take_in_hand(context, context.open.in_hand == tool ? nullptr : tool); }

void open_dialog(ToolContext& context, HasDialogs* owner, int kind) {
  context.open.dialog = {owner, kind};
  context.follow_soon = true;
  set_cover(context, Cover::none);
}

void set_cover(ToolContext& context, Cover cover) {
  if (cover == context.open.cover) return;
  if (std::exchange(context.open.cover, cover) == Cover::warnings) context.trace.line("warnings closed");
  if (cover != Cover::warnings) return;
  context.notices.read_warnings();
  const std::size_t errors = notices::error_count(context.link.document.warnings());
  context.trace.line(fmt::format("warnings shown errors {} warnings {}", errors, context.link.document.warnings().size() - errors));
}

}  // namespace prismesh::kiosk::toolkit

#include "kiosk/toolkit/edits.h"

#include <utility>

#include "kiosk/toolkit/selected_nodes.h"
#include "kiosk/toolkit/tool_set.h"

namespace prismesh::kiosk::toolkit {

void send(ToolContext& context, mesh::document::Edit edit) {
  if (!context.tools.allow_edit() || context.tools.hold(edit, true)) return;
  context.tools.edit_begins();
  context.link.edits.send(std::move(edit));
}

void bring_selection(ToolContext& context) {
  PictureView& view = context.view;
  if (context.selection.centre && view.profile.stereo()) view.depth.bring(*context.selection.centre, context.clock.now_ns());
}

void take_model(ToolContext& context) {
  const auto& shown = context.shown.snapshot;
  if (!shown) {
    context.selection.last_clicked.reset();
    context.selection.centre.reset();
  } else {
    const std::optional<mesh::Vec3> centre = shown->info().selected_nodes > 0 ? selection_centre(*context.renderer.model()) : std::nullopt;
    const bool elsewhere = centre != context.selection.centre;
    context.selection.centre = centre;
    if (elsewhere && context.view.depth.keeps_selection()) bring_selection(context);
  }
  for (const auto& tool : context.tools.all()) tool->model_changed();
}

}  // namespace prismesh::kiosk::toolkit

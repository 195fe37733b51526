// Sends edits, and follows the selection that they leave.
#pragma once

#include "kiosk/toolkit/tool_context.h"

namespace prismesh::kiosk::toolkit {

/// Sends an edit to the model server. All edits go this way: none is made while an older state is shown.
void send(ToolContext& context, mesh::document::Edit edit);

/// Moves the middle of the selection into the plane of the screen, where both eyes see it at the same place.
void bring_selection(ToolContext& context);

/// Takes the renderer's model: finds the middle of its selection and tells the tools.
void take_model(ToolContext& context);

}  // namespace prismesh::kiosk::toolkit

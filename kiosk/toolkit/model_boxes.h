// Boxes about pieces of the shown model, for views that are fitted to them. Each costs a pass over the model.
#pragma once

#include "kiosk/toolkit/tool_context.h"

namespace prismesh::kiosk::toolkit {

/// Around the selected nodes, in axes turned as the view is; empty if none is selected.
stereo::Box turned_box_of_selection(const ToolContext& context);
/// Around the nodes of a part's shells, in the same axes; empty if it has none.
stereo::Box turned_box_of_part(const ToolContext& context, mesh::PartIndex part);
/// The room that a view is fitted to, in mm: that of one view, where there are two.
Eigen::Vector2d room_of_view_mm(const PictureView& view);

}  // namespace prismesh::kiosk::toolkit

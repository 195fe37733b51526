// Where the pointer aims and what it hits, in a picture of one or two views.
#pragma once

#include <optional>

#include "kiosk/input/gestures.h"
#include "kiosk/toolkit/tool_context.h"

namespace prismesh::kiosk::toolkit {

/// View, eyes, display and colours, without what stands in the picture.
render::Picture plain_picture(const PictureView& view);

/// The part of the picture that the model is seen in.
render::PixelRect room(const PictureView& view);
/// Its size in mm on the screen.
Eigen::Vector2d room_mm(const PictureView& view);
/// Its middle in mm from the screen's.
Eigen::Vector2d room_middle_mm(const PictureView& view);
/// How two views share it: the border in its middle, each view in the middle of its half.
render::TwoViews two_views(const PictureView& view);
/// The shift of each in mm on the screen.
double pane_shift_mm(const PictureView& view);

/// Aims into the view that things are picked in: the right one of two.
stereo::Aim aim(const PictureView& view);
/// Whether a pixel is in the left one of two views, which is only shown.
bool is_beside(const PictureView& view, const input::Pixel& pixel);
/// The same place in the view that things are picked in.
input::Pixel in_picked_view(const PictureView& view, const input::Pixel& pixel);

/// Where a point of the view that things are picked in is seen: there, and in the left one of two views; only places that lie in their
/// view.
std::vector<input::Pixel> in_each_view(const PictureView& view, const input::Pixel& picked);

/// Whether something can be picked at a pixel.
bool is_pickable(const ToolContext& context, const input::Pixel& pixel);
/// The visible node nearest to a pixel; nothing within reach: none. May be newer than the shown snapshot.
std::optional<mesh::NodeIndex> node_at(const ToolContext& context, const input::Pixel& pixel);
/// The same, if the shown snapshot has it.
std::optional<mesh::NodeIndex> shown_node_at(const ToolContext& context, const input::Pixel& pixel);
/// The shell under a pixel, where something can be picked.
std::optional<mesh::ShellIndex> shell_at(const ToolContext& context, const std::optional<input::Pixel>& pixel);

/// What is under the pointer, in words too.
/// Whether an element uses the node. Costs a pass over the elements.
bool is_used(const ToolContext& context, mesh::NodeIndex node);
/// Whether what was pointed at isn't in the model any more, or is hidden now.
bool is_out_of_sight(const PointedAt& pointed, const render::ModelSource& model);
PointedAt pointed_at(const ToolContext& context, const std::optional<input::Pixel>& pixel);

/// The node with an id, also one that an edit removed; nothing if the shown snapshot hasn't got it. Costs a pass over the ids.
std::optional<mesh::NodeIndex> node_with_id(const ToolContext& context, std::int64_t id);
/// The shell with an id; nothing if the shown snapshot hasn't got it. Costs a pass over the ids.
std::optional<mesh::ShellIndex> shell_with_id(const ToolContext& context, std::int64_t id);

}  // namespace prismesh::kiosk::toolkit

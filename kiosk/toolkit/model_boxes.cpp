#include "kiosk/toolkit/model_boxes.h"

#include "kiosk/toolkit/picking.h"

namespace prismesh::kiosk::toolkit {
namespace {

void add_turned(stereo::Box& box, const Eigen::Matrix3d& turn, const mesh::Vec3& point) {
  if (point.allFinite()) box.add(mesh::Vec3(turn * point));
}

}  // namespace

stereo::Box turned_box_of_selection(const ToolContext& context) {
  stereo::Box box;
  const auto& shown = context.shown.snapshot;
  if (!shown || shown->info().selected_nodes == 0) return box;
  const Eigen::Matrix3d turn = context.view.view.rotation.toRotationMatrix();
  for (std::size_t n = 0; n < shown->node_count(); ++n)
    if (shown->selected(n)) add_turned(box, turn, shown->position(n));
  return box;
}

stereo::Box turned_box_of_part(const ToolContext& context, mesh::PartIndex part) {
  stereo::Box box;
  const auto& shown = context.shown.snapshot;
  if (!shown) return box;
  const Eigen::Matrix3d turn = context.view.view.rotation.toRotationMatrix();
  for (std::size_t s = 0; s < shown->shell_count(); ++s) {
    if (shown->shell_part(s) != part) continue;
    for (const mesh::NodeIndex node : shown->shell(s).node)
      if (node.valid() && node.value < shown->node_count()) add_turned(box, turn, shown->position(node.value));
  }
  return box;
}

Eigen::Vector2d room_of_view_mm(const PictureView& view) {
  Eigen::Vector2d room = room_mm(view);
  if (view.two_views) room.x() *= 0.5;
  return room;
}

}  // namespace prismesh::kiosk::toolkit

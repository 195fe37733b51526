#include "kiosk/toolkit/model_boxes.h"

#include <algorithm>

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
  if (box.empty()) return box;
  stereo::Box around = box;
  for (std::size_t s = 0; s < shown->shell_count(); ++s) {
    const mesh::ShellNodes& shell = shown->shell(s);
    const auto is_there = [&](mesh::NodeIndex node) { return node.valid() && node.value < shown->node_count(); };
    if (!std::ranges::any_of(shell.node, [&](mesh::NodeIndex node) { return is_there(node) && shown->selected(node.value); })) continue;
    for (const mesh::NodeIndex node : shell.node)
      if (is_there(node)) add_turned(around, turn, shown->position(node.value));
  }
  // A node has no size of its own to be fitted.
  return (box.high - box.low).norm() < 0.5 * (around.high - around.low).norm() ? around : box;
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

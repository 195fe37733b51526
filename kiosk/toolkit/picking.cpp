#include "kiosk/toolkit/picking.h"

#include <algorithm>

namespace prismesh::kiosk::toolkit {
namespace {

using input::Pixel;

constexpr double kPickRadiusPixels = 16;

}  // namespace

render::Picture plain_picture(const PictureView& view) {
  render::Picture picture;
  picture.view = view.view;
  picture.profile = view.profile;
  picture.between_eyes_mm = view.seen.between_eyes_mm;
  picture.toward_right = view.seen.toward_right;
  picture.eye_separation_mm = view.seen.eye_separation_mm;
  picture.depth_share = view.seen.depth_share;
  picture.mask_mm = view.seen.mask_mm;
  picture.panel = view.panel;
  picture.colour = view.colour;
  picture.shadows = view.shadows;
  return picture;
}

double pane_shift(const PictureView& view) { return 0.25 * std::max(0.2, 1 - view.covered_width / std::max(view.size.width, 1)); }

double pane_shift_mm(const PictureView& view) {
  return pane_shift(view) * stereo::screen_size_mm(view.profile, view.size.width, view.size.height).x();
}

stereo::Aim aim(const PictureView& view) {
  render::Picture picture = plain_picture(view);
  if (view.two_views) picture.view = stereo::pan(view.view, {pane_shift_mm(view), 0});
  return render::aim_for(picture, view.size.width, view.size.height);
}

bool is_beside(const PictureView& view, const Pixel& pixel) { return view.two_views && pixel.x() <= 0.5 * view.size.width; }

/// What is in the left view is in the right one too, unless it came or went in between.
Pixel in_picked_view(const PictureView& view, const Pixel& pixel) {
  const bool left = view.two_views && pixel.x() < 0.5 * view.size.width;
  return left ? Pixel(pixel.x() + 2 * pane_shift(view) * view.size.width, pixel.y()) : pixel;
}

bool is_pickable(const ToolContext& context, const Pixel& pixel) { return !context.shown.older && !is_beside(context.view, pixel); }

std::optional<mesh::NodeIndex> node_at(const ToolContext& context, const Pixel& pixel) {
  return is_pickable(context, pixel) ? context.renderer.node_near(aim(context.view), pixel, kPickRadiusPixels) : std::nullopt;
}

std::optional<mesh::NodeIndex> shown_node_at(const ToolContext& context, const Pixel& pixel) {
  const std::optional<mesh::NodeIndex> node = context.shown.snapshot ? node_at(context, pixel) : std::nullopt;
  return node && node->value < context.shown.snapshot->node_count() ? node : std::nullopt;
}

std::optional<mesh::ShellIndex> shell_at(const ToolContext& context, const std::optional<Pixel>& pixel) {
  const bool pickable = pixel && context.shown.snapshot && is_pickable(context, *pixel);
  return pickable ? context.renderer.shell_at(aim(context.view), *pixel) : std::nullopt;
}

std::optional<mesh::ShellIndex> shell_with_id(const ToolContext& context, std::int64_t id) {
  const auto& shown = context.shown.snapshot;
  if (!shown) return std::nullopt;
  for (std::size_t c = 0; c < shown->chunk_count(ipc::SnapshotArray::shell_ids); ++c) {
    const auto ids = shown->chunk<std::int64_t>(ipc::SnapshotArray::shell_ids, c);
    for (std::size_t i = 0; i < ids.size(); ++i)
      if (ids[i] == id && shown->shell(c * mesh::kChunkSize + i).node[0].valid()) return mesh::ShellIndex(c * mesh::kChunkSize + i);
  }
  return std::nullopt;
}

}  // namespace prismesh::kiosk::toolkit

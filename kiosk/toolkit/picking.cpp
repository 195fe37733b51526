#include "kiosk/toolkit/picking.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/readable_number.h"
#include "kiosk/panels/text.h"

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
  picture.thickness = view.thickness;
  return picture;
}

render::PixelRect room(const PictureView& view) {
  const render::PixelRect& room = view.room;
  const bool some = room.x1 > room.x0 && room.y1 > room.y0;
  return some ? room : render::PixelRect{0, 0, static_cast<double>(view.size.width), static_cast<double>(view.size.height)};
}

Eigen::Vector2d room_mm(const PictureView& view) {
  const render::PixelRect rect = room(view);
  const Eigen::Vector2d screen = stereo::screen_size_mm(view.profile, view.size.width, view.size.height);
  return {screen.x() * (rect.x1 - rect.x0) / std::max(view.size.width, 1),
          screen.y() * (rect.y1 - rect.y0) / std::max(view.size.height, 1)};
}

Eigen::Vector2d room_middle_mm(const PictureView& view) {
  const render::PixelRect rect = room(view);
  const Eigen::Vector2d screen = stereo::screen_size_mm(view.profile, view.size.width, view.size.height);
  return {screen.x() * (0.5 * (rect.x0 + rect.x1) / std::max(view.size.width, 1) - 0.5),
          screen.y() * (0.5 - 0.5 * (rect.y0 + rect.y1) / std::max(view.size.height, 1))};
}

render::TwoViews two_views(const PictureView& view) {
  const render::PixelRect rect = room(view);
  const double width = std::max(view.size.width, 1);
  return {true, 0.25 * (rect.x1 - rect.x0) / width, 0.5 * (rect.x0 + rect.x1) / width};
}

double pane_shift_mm(const PictureView& view) {
  return two_views(view).shift * stereo::screen_size_mm(view.profile, view.size.width, view.size.height).x();
}

namespace {
double border_pixel(const PictureView& view) { return two_views(view).border * view.size.width; }
}  // namespace

stereo::Aim aim(const PictureView& view) {
  render::Picture picture = plain_picture(view);
  if (view.two_views) picture.view = stereo::pan(view.view, {pane_shift_mm(view), 0});
  return render::aim_for(picture, view.size.width, view.size.height);
}

bool is_beside(const PictureView& view, const Pixel& pixel) { return view.two_views && pixel.x() <= border_pixel(view); }

/// What is in the left view is in the right one too, unless it came or went in between.
Pixel in_picked_view(const PictureView& view, const Pixel& pixel) {
  const bool left = view.two_views && pixel.x() < border_pixel(view);
  return left ? Pixel(pixel.x() + 2 * two_views(view).shift * view.size.width, pixel.y()) : pixel;
}

std::vector<Pixel> in_each_view(const PictureView& view, const Pixel& picked) {
  if (!view.two_views) return {picked};
  std::vector<Pixel> places;
  const Pixel beside(picked.x() - 2 * two_views(view).shift * view.size.width, picked.y());
  if (picked.x() > border_pixel(view)) places.push_back(picked);
  if (beside.x() <= border_pixel(view)) places.push_back(beside);
  return places;
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

bool is_out_of_sight(const PointedAt& pointed, const render::ModelSource& model) {
  if (pointed.words.empty()) return false;
  const std::size_t shells = model.size(ipc::SnapshotArray::shell_parts);
  const auto hidden = [&](std::size_t shell) {
    const std::size_t part = model.at<mesh::PartIndex>(ipc::SnapshotArray::shell_parts, shell).value;
    return part < model.part_count() && model.part_hidden(part);
  };
  if (pointed.shell) return pointed.shell->value >= shells || hidden(pointed.shell->value);
  if (!pointed.node) return false;
  return pointed.node->value >= model.size(ipc::SnapshotArray::positions);
}

PointedAt pointed_at(const ToolContext& context, const std::optional<Pixel>& pixel) {
  PointedAt found;
  const auto& shown = context.shown.snapshot;
  if (!pixel || !shown) return found;
  found.node = shown_node_at(context, *pixel);
  found.shell = shell_at(context, pixel);
  if (found.shell && found.shell->value >= shown->shell_count()) found.shell.reset();
  const ipc::SnapshotInfo& info = shown->info();
  if (found.node) {
    const mesh::Vec3& at = shown->position(found.node->value);
    found.words = fmt::format("node {}  ({} {} {}) {}", shown->node_id(found.node->value), readable(at.x(), 6), readable(at.y(), 6),
                              readable(at.z(), 6), info.length_unit);
  }
  if (!found.shell) return found;
  if (!found.words.empty()) found.words += "   ";
  found.words += fmt::format("shell {}", shown->shell_id(found.shell->value));
  const mesh::PartIndex part = shown->shell_part(found.shell->value);
  if (part.value >= info.parts.size()) return found;
  const ipc::SnapshotPart& its = info.parts[part.value];
  found.words += fmt::format("   part {} {}", its.id, panels::printable(its.name));
  if (its.thinnest > 0)
    found.words += fmt::format("  {}{} {} thick", readable(its.thinnest, 4),
                               its.thickest > its.thinnest ? " to " + readable(its.thickest, 4) : "", info.length_unit);
  return found;
}

std::optional<mesh::NodeIndex> node_with_id(const ToolContext& context, std::int64_t id) {
  const auto& shown = context.shown.snapshot;
  if (!shown) return std::nullopt;
  for (std::size_t c = 0; c < shown->chunk_count(ipc::SnapshotArray::node_ids); ++c) {
    const auto ids = shown->chunk<std::int64_t>(ipc::SnapshotArray::node_ids, c);
    const auto found = std::ranges::find(ids, id);
    if (found != ids.end()) return mesh::NodeIndex(c * mesh::kChunkSize + static_cast<std::size_t>(found - ids.begin()));
  }
  return std::nullopt;
}

bool is_used(const ToolContext& context, mesh::NodeIndex node) {
  const auto& shown = context.shown.snapshot;
  if (!shown) return false;
  for (std::size_t c = 0; c < shown->chunk_count(ipc::SnapshotArray::shell_nodes); ++c)
    for (const mesh::ShellNodes& shell : shown->chunk<mesh::ShellNodes>(ipc::SnapshotArray::shell_nodes, c))
      if (std::ranges::find(shell.node, node) != std::end(shell.node)) return true;
  for (std::size_t c = 0; c < shown->chunk_count(ipc::SnapshotArray::line_nodes); ++c) {
    const auto ends = shown->chunk<mesh::NodeIndex>(ipc::SnapshotArray::line_nodes, c);
    if (std::ranges::find(ends, node) != ends.end()) return true;
  }
  return false;
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

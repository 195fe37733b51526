// The editor's selecting: clicks, outlines, regions, expressions, and parts and files out of sight or locked.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "kiosk/editor.h"
#include "kiosk/tools/file_expression.h"
#include "kiosk/tools/outline.h"
#include "mesh/select/expression.h"

namespace prismesh::kiosk {
namespace {

using mesh::document::SelectMode;
using mesh::document::VisibilityAction;
using tools::Command;
using tools::Pixel;

constexpr double kPickRadiusPixels = 16;
constexpr std::size_t kMinLassoPoints = 3;

render::PixelRect rectangle_of(const Pixel& a, const Pixel& b) {
  return {std::min(a.x(), b.x()), std::min(a.y(), b.y()), std::max(a.x(), b.x()), std::max(a.y(), b.y())};
}

std::vector<Pixel> corners_of(const render::PixelRect& rect) {
  return {{rect.x0, rect.y0}, {rect.x1, rect.y0}, {rect.x1, rect.y1}, {rect.x0, rect.y1}};
}

std::vector<std::array<double, 2>> outline_of(const std::vector<Pixel>& pixels, const display::PixelSize& size) {
  std::vector<std::array<double, 2>> outline;
  outline.reserve(pixels.size());
  for (const Pixel& pixel : pixels) outline.push_back({2 * pixel.x() / size.width - 1, 1 - 2 * pixel.y() / size.height});
  return outline;
}

}  // namespace

std::optional<mesh::NodeIndex> Editor::node_at(const Pixel& pixel) {
  return pickable(pixel) ? renderer_.node_near(aim(), pixel, kPickRadiusPixels) : std::nullopt;
}

void Editor::select_nodes(const mesh::NodeSet& nodes, SelectMode mode) {
  last_region_.reset();
  std::vector<std::int64_t> ids;
  ids.reserve(nodes.size());
  for (const mesh::NodeIndex node : nodes)
    if (node.value < shown_->node_count()) ids.push_back(shown_->node_id(node.value));
  mesh::document::Select edit;
  edit.expr = mesh::select::to_expression(std::move(ids));
  edit.mode = mode;
  send(std::move(edit));
}

void Editor::clear_selection() {
  last_clicked_.reset();
  last_region_.reset();
  if (!shown_ || shown_->info().selected_nodes == 0) return;
  mesh::document::Select edit;
  edit.expr = "all";
  edit.mode = SelectMode::subtract;
  send(std::move(edit));
}

void Editor::handle(const tools::NodeClicked& click) {
  if (!shown_) return;
  if (axis_pick_.active()) return axis_clicked(click.at);
  if (by_hand_.operation) return operation_clicked(click.at);
  const std::optional<mesh::NodeIndex> node = node_at(click.at);
  if (!node) {
    if (click.mode == SelectMode::set) clear_selection();
    return;
  }
  if (click.mode != SelectMode::subtract) last_clicked_ = node;
  select_nodes({*node}, click.mode);
}

void Editor::handle(const tools::RegionClicked& click) {
  if (axis_pick_.active()) return axis_clicked(click.at);
  if (by_hand_.operation) return operation_clicked(click.at);
  select_region(click.at, click.mode);
}

void Editor::select_region(const Pixel& at, SelectMode mode) {
  if (!shown_) return;
  const std::optional<mesh::NodeIndex> node = node_at(at);
  if (!node || node->value >= shown_->node_count()) return;
  if (mode != SelectMode::subtract) last_clicked_ = node;
  mesh::document::SelectRegion edit;
  edit.at = shown_->node_id(node->value);
  edit.angle = region_angle_;
  edit.by = region_by_;
  edit.across_welds = region_across_welds_;
  edit.mode = mode;
  last_region_ = edit;
  send(edit);
}

/// The region that was picked last follows the angle.
void Editor::change_angle(double degrees) {
  region_angle_ = std::clamp(region_angle_ + degrees, 0.0, 180.0);
  ++changes_;
  trace_.line(fmt::format("angle {}", region_angle_));
  if (!last_region_ || last_region_->mode != SelectMode::set || last_region_->by != mesh::document::RegionBy::features) return;
  last_region_->angle = region_angle_;
  send(*last_region_);
}

void Editor::handle(const tools::TakeBackClicked&) {
  last_region_.reset();
  if (shown_ && shown_->info().can_undo && is_selecting(link_.made_by())) send(mesh::document::Undo{});
}

void Editor::handle(const tools::OutlineDrawn& outline) {
  if (is_rectangle(outline.other_kind))
    rubber_band_ = rectangle_of(outline.way.front(), outline.way.back());
  else
    lasso_way_ = outline.way;
}

void Editor::handle(const tools::OutlineDone& outline) {
  rubber_band_.reset();
  lasso_way_.clear();
  if (!shown_ || outline.way.empty()) return;
  std::vector<Pixel> way =
      is_rectangle(outline.other_kind) ? corners_of(rectangle_of(outline.way.front(), outline.way.back())) : outline.way;
  if (comparing_.two_views()) way = tools::kept_right_of(way, 0.5 * size_.width);  // beyond the cut nothing of this view is seen
  if (way.size() < kMinLassoPoints) return;
  if (outline.mode == SelectMode::set) last_clicked_.reset();
  last_region_.reset();
  mesh::document::SelectLasso edit;
  edit.outline = outline_of(way, size_);
  const Eigen::Matrix4d clip = aim().clip_from_deck();
  std::copy_n(clip.data(), 16, edit.view.begin());  // both are column-major
  edit.visible = !through_;
  edit.mode = outline.mode;
  send(std::move(edit));
}

// --- expressions ---

void Editor::open_expression() {
  if (shown_) open_dialog(panels::Dialog::expression);
}

void Editor::expression_changed(const panels::ExpressionTyped& typed) {
  if (!typed.text.empty()) link_.count(typed.text, typed.kind);
}

void Editor::enter_expression(const panels::ExpressionEntered& entered) {
  if (entered.text.empty()) return;
  expressions_.add(entered.text);
  last_region_.reset();
  last_clicked_.reset();
  mesh::document::Select edit;
  edit.expr = entered.text;
  edit.kind = entered.kind;
  edit.mode = entered.mode;
  send(std::move(edit));
}

// --- parts and files ---

std::optional<mesh::PartIndex> Editor::part_at(const std::optional<Pixel>& pointer) {
  const auto shell = pointer && shown_ && pickable(*pointer) ? renderer_.shell_at(aim(), *pointer) : std::nullopt;
  if (!shell || shell->value >= shown_->shell_count()) return std::nullopt;
  const mesh::PartIndex part = shown_->shell_part(shell->value);
  return part.value < shown_->info().parts.size() ? std::optional(part) : std::nullopt;
}

void Editor::set_parts(VisibilityAction action, const std::optional<Pixel>& pointer) {
  if (!shown_) return;
  mesh::document::SetParts edit;
  edit.action = action;
  if (const auto part = part_at(pointer)) edit.on = std::to_string(shown_->info().parts[part->value].id);
  send(std::move(edit));
}

/// The file of the part under the pointer; of several files that hold the part the first.
void Editor::set_file(Command command, const std::optional<Pixel>& pointer) {
  const auto part = part_at(pointer);
  if (!part || !link_.state()) return;
  const std::int64_t id = shown_->info().parts[part->value].id;
  for (const ipc::DeckFile& file : link_.state()->files) {
    if (!std::binary_search(file.parts.begin(), file.parts.end(), id)) continue;
    const bool locked = shown_->info().parts[part->value].locked;
    mesh::document::SetParts edit;
    edit.action = command == Command::hide_file   ? VisibilityAction::hide
                  : command == Command::only_file ? VisibilityAction::only
                  : locked                        ? VisibilityAction::unlock
                                                  : VisibilityAction::lock;
    edit.on = tools::file_expression(file.name);
    return send(std::move(edit));
  }
}

void Editor::show_all() {
  if (!shown_) return;
  std::vector<std::int64_t> hidden;
  for (const ipc::SnapshotPart& part : shown_->info().parts)
    if (part.hidden) hidden.push_back(part.id);
  if (hidden.empty()) return;
  mesh::document::SetParts edit;
  edit.action = VisibilityAction::show;
  edit.on = mesh::select::to_expression(std::move(hidden));
  send(std::move(edit));
}

}  // namespace prismesh::kiosk

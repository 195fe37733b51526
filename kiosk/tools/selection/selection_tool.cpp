#include "kiosk/tools/selection/selection_tool.h"

#include <algorithm>

#include <fmt/format.h>

#include "kiosk/input/key_table.h"
#include "kiosk/toolkit/edits.h"
#include "kiosk/toolkit/open_panels.h"
#include "kiosk/toolkit/picking.h"
#include "kiosk/tools/selection/outline.h"
#include "kiosk/tools/selection/selection_keys.h"
#include "mesh/select/expression.h"

namespace prismesh::kiosk::tools::selection {
namespace {

using input::NodeClicked;
using input::OutlineDone;
using input::OutlineDrawn;
using input::Pixel;
using panels::PanelLayout;

using mesh::document::RegionBy;
using mesh::document::SelectMode;

constexpr std::size_t kMinLassoPoints = 3;
constexpr double kAngleStep = 5;  ///< degrees

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

std::span<const input::KeyBinding> keys() { return kKeys; }

std::string_view SelectionTool::name() const { return kName; }

void SelectionTool::command(std::uint8_t number, const toolkit::Pointer& pointer) {
  switch (static_cast<SelectionCommand>(number)) {
    case SelectionCommand::take_in_hand: toolkit::take_in_hand(context_, nullptr); break;
    case SelectionCommand::expression:
      if (context_.shown.snapshot) toolkit::open_dialog(context_, this);
      break;
    case SelectionCommand::outline_kind: draws_lasso_ = !draws_lasso_; break;
    case SelectionCommand::toggle_through: through_ = !through_; break;
    case SelectionCommand::grow: toolkit::send(context_, mesh::document::Grow{}); break;
    case SelectionCommand::shrink: toolkit::send(context_, mesh::document::Shrink{}); break;
    case SelectionCommand::invert: toolkit::send(context_, mesh::document::Invert{}); break;
    case SelectionCommand::region:
      if (pointer) select_region(*pointer, SelectMode::set);
      break;
    case SelectionCommand::region_by: region_by_ = static_cast<RegionBy>((static_cast<int>(region_by_) + 1) % kRegionBounds); break;
    case SelectionCommand::wider_angle: change_angle(kAngleStep); break;
    case SelectionCommand::narrower_angle: change_angle(-kAngleStep); break;
    case SelectionCommand::region_across_welds: region_across_welds_ = !region_across_welds_; break;
  }
}

// --- gestures ---

bool SelectionTool::gesture(const input::Gesture& gesture) {
  if (const auto* node = std::get_if<NodeClicked>(&gesture))
    click(*node);
  else if (const auto* region = std::get_if<input::RegionClicked>(&gesture))
    select_region(region->at, region->mode);
  else if (std::holds_alternative<input::TakeBackClicked>(gesture))
    step_back();
  else if (const auto* drawn = std::get_if<OutlineDrawn>(&gesture))
    draw(*drawn);
  else if (const auto* done = std::get_if<OutlineDone>(&gesture))
    take(*done);
  else if (const auto* turned = std::get_if<input::AngleTurned>(&gesture))
    change_angle(turned->steps * kAngleStep);
  else
    return false;
  return true;
}

void SelectionTool::click(const NodeClicked& click) {
  if (!context_.shown.snapshot) return;
  const std::optional<mesh::NodeIndex> node = toolkit::node_at(context_, click.at);
  if (!node) {
    if (click.mode == SelectMode::set) clear();
    return;
  }
  if (click.mode != SelectMode::subtract) context_.selection.last_clicked = node;
  select_node(*node, click.mode);
}

void SelectionTool::step_back() {
  context_.selection.last_region.reset();
  const auto& shown = context_.shown.snapshot;
  if (shown && shown->info().can_undo && link::is_selecting(context_.link.document.made_by()))
    toolkit::send(context_, mesh::document::Undo{});
}

void SelectionTool::draw(const OutlineDrawn& outline) {
  if (is_rectangle(outline.other_kind))
    rubber_band_ = rectangle_of(outline.way.front(), outline.way.back());
  else
    lasso_ = outline.way;
}

void SelectionTool::take(const OutlineDone& outline) {
  rubber_band_.reset();
  lasso_.clear();
  if (!context_.shown.snapshot || outline.way.empty()) return;
  const display::PixelSize size = context_.view.size;
  std::vector<Pixel> way =
      is_rectangle(outline.other_kind) ? corners_of(rectangle_of(outline.way.front(), outline.way.back())) : outline.way;
  if (context_.view.two_views) way = kept_right_of(way, toolkit::two_views(context_.view).border * size.width);  // the picture is cut there
  if (way.size() < kMinLassoPoints) return;
  if (outline.mode == SelectMode::set) context_.selection.last_clicked.reset();
  context_.selection.last_region.reset();
  mesh::document::SelectLasso edit;
  edit.outline = outline_of(way, size);
  const stereo::Aim aim = toolkit::aim(context_.view);
  const std::optional<render::CutPicture>& cut = context_.renderer.cut();
  const Eigen::Matrix4d clip = cut ? stereo::clip_with_cut(aim, cut->point, cut->normal) : aim.clip_from_deck();
  std::copy_n(clip.data(), 16, edit.view.begin());  // both are column-major
  edit.visible = !through_;
  edit.mode = outline.mode;
  toolkit::send(context_, std::move(edit));
}

void SelectionTool::cancel_gesture() {
  rubber_band_.reset();
  lasso_.clear();
}

// --- what is selected ---

void SelectionTool::clear() {
  context_.selection.last_clicked.reset();
  context_.selection.last_region.reset();
  if (!context_.shown.snapshot || context_.shown.snapshot->info().selected_nodes == 0) return;
  mesh::document::Select edit;
  edit.expr = "all";
  edit.mode = SelectMode::subtract;
  toolkit::send(context_, std::move(edit));
}

void SelectionTool::select_node(mesh::NodeIndex node, SelectMode mode) {
  context_.selection.last_region.reset();
  std::vector<std::int64_t> ids;
  if (node.value < context_.shown.snapshot->node_count()) ids.push_back(context_.shown.snapshot->node_id(node.value));
  mesh::document::Select edit;
  edit.expr = mesh::select::to_expression(std::move(ids));
  edit.mode = mode;
  toolkit::send(context_, std::move(edit));
}

void SelectionTool::select_region(const Pixel& at, SelectMode mode) {
  const std::optional<mesh::NodeIndex> node = toolkit::shown_node_at(context_, at);
  if (!node) return;
  if (mode != SelectMode::subtract) context_.selection.last_clicked = node;
  mesh::document::SelectRegion edit = region(context_.shown.snapshot->node_id(node->value));
  edit.mode = mode;
  context_.selection.last_region = edit;
  toolkit::send(context_, edit);
}

mesh::document::SelectRegion SelectionTool::region(std::int64_t node) const {
  mesh::document::SelectRegion region;
  region.at = node;
  region.angle = context_.selection.crease_angle;
  region.by = region_by_;
  region.across_welds = region_across_welds_;
  return region;
}

/// The region that was selected last follows the angle.
void SelectionTool::change_angle(double degrees) {
  double& angle = context_.selection.crease_angle;
  angle = std::clamp(angle + degrees, 0.0, 180.0);
  ++context_.changes;
  context_.trace.line(fmt::format("angle {}", angle));
  auto& region = context_.selection.last_region;
  if (!region || region->mode != SelectMode::set || !has_angle(region->by)) return;
  region->angle = angle;
  toolkit::send(context_, *region);
}

void SelectionTool::set_region(const RegionSettings& region) {
  region_by_ = region.by;
  region_across_welds_ = region.across_welds;
  const double angle = context_.selection.crease_angle;
  if (region.angle != angle) change_angle(region.angle - angle);
}

void SelectionTool::enter(const ExpressionEntered& entered) {
  if (entered.text.empty()) return;
  expressions_.add(entered.text);
  context_.selection.last_region.reset();
  context_.selection.last_clicked.reset();
  mesh::document::Select edit;
  edit.expr = entered.text;
  edit.kind = entered.kind;
  edit.mode = entered.mode;
  toolkit::send(context_, std::move(edit));
}

// --- picture and panels ---

void SelectionTool::add_to_picture(render::Picture& picture) const {
  picture.rubber_band = rubber_band_;
  picture.lasso = lasso_;
}

std::vector<toolkit::RailEntry> SelectionTool::rail() const {
  return {{toolkit::RailPlace::select, "Select", &input::binding_of(kKeys, command_of(SelectionCommand::take_in_hand)),
           context_.open.in_hand == nullptr}};
}

void SelectionTool::draw_options(panels::OptionRow& row) {
  const auto key = [](SelectionCommand command) -> const input::KeyBinding& { return input::binding_of(kKeys, command_of(command)); };
  row.value("draw", draws_lasso_ ? "lasso" : "rectangle", key(SelectionCommand::outline_kind));
  row.value("takes", through_ ? "all through" : "visible", key(SelectionCommand::toggle_through));
  row.value("region", bounds_words(region_by_), key(SelectionCommand::region_by));
  row.command("grow", key(SelectionCommand::grow));
  row.command("shrink", key(SelectionCommand::shrink));
  row.command("invert", key(SelectionCommand::invert));
  row.command("by expression", key(SelectionCommand::expression));
}

std::string SelectionTool::setting_words() const {
  return std::string("Select \u00b7 ") + (draws_lasso_ ? "lasso" : "rectangle") + (through_ ? " through" : "") + " \u00b7 " +
         bounds_words(region_by_);
}

void SelectionTool::draw_panel(PanelLayout& layout) {
  const ipc::SnapshotInfo& info = context_.shown.snapshot->info();
  SelectFacts facts;
  facts.nodes = info.selected_nodes;
  facts.shells = info.selected_shells;
  facts.lasso = draws_lasso_;
  facts.through = through_;
  facts.region = {region_by_, context_.selection.crease_angle, region_across_welds_};
  if (const std::optional<RegionSettings> wanted = select_section(facts, layout))
    layout.ask([this, region = *wanted] { set_region(region); });
}

void SelectionTool::draw_dialog(int, bool opened, PanelLayout& layout) {
  ExpressionFacts facts;
  facts.earlier = &expressions_.entries();
  if (const auto& counted = context_.link.count.answer()) {
    facts.counted_for = counted->expr;
    if (counted->counted) facts.count = ExpressionFacts::Count{counted->counted->nodes, counted->counted->shells, counted->counted->parts};
    if (counted->failed) facts.problem = Error{counted->failed->file, counted->failed->line, counted->failed->message}.text();
    if (counted->failed && counted->failed->file == "expression") facts.column = counted->failed->line;
  }
  const ExpressionAsked asked = expression_box(facts, layout.view(), opened, entry_);
  if (asked.typed)
    layout.ask([this, typed = *asked.typed] {
      if (!typed.text.empty()) context_.link.count.ask(typed.text, typed.kind);
    });
  if (!asked.entered) return;
  layout.ask([this, entered = *asked.entered] { enter(entered); });
  layout.ask([this] { toolkit::close_dialog(context_); });
}

}  // namespace prismesh::kiosk::tools::selection

// The axes and the options of the shaping tool.
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "kiosk/input/typed_numbers.h"
#include "kiosk/toolkit/open_panels.h"
#include "kiosk/toolkit/picking.h"
#include "kiosk/tools/shaping/falloff_direction.h"
#include "kiosk/tools/shaping/shaping_tool.h"

namespace prismesh::kiosk::tools::shaping {

using input::Under;
using notices::Notice;
using toolkit::Pointer;

// --- axes ---

void ShapingTool::set_axis(const std::optional<Axis>& axis, const std::string& what) {
  if (pull_) return;
  axis_pick_.cancel();
  axis_ = axis;
  handle_ = axis ? Under::turn_handle : Under::lift_handle;
  std::string text = "axis " + what;
  if (axis)
    for (const mesh::Vec3& each : {axis->point, axis->direction}) text += fmt::format(" {} {} {}", each.x(), each.y(), each.z());
  context_.trace.line(text);
  context_.follow_soon = true;
}

void ShapingTool::pick_two_nodes(TwoNodes purpose) {
  if (pull_ || !context_.shown.snapshot) return;
  picks_ = purpose;
  axis_pick_.begin();
  context_.trace.line(purpose == TwoNodes::axis ? "axis picking" : "falloff picking");
}

void ShapingTool::click_node(const input::Pixel& at) {
  const std::optional<mesh::NodeIndex> node = toolkit::shown_node_at(context_, at);
  if (!node) return;
  const std::optional<Axis> axis = axis_pick_.clicked(context_.shown.snapshot->position(node->value));
  const bool for_axis = picks_ == TwoNodes::axis;
  if (!axis)
    context_.trace.line(for_axis ? "axis first node" : "falloff first node");
  else if (for_axis)
    set_axis(axis, "through two nodes");
  else
    set_falloff(picked_falloff("two nodes", axis->direction));
}

std::optional<EdgeAxis> ShapingTool::edge_under(const Pointer& pointer) const {
  const auto shell = toolkit::shell_at(context_, pointer);
  return shell ? edge_at(*context_.renderer.model(), toolkit::aim(context_.view), *shell, *pointer, context_.selection.crease_angle)
               : std::nullopt;
}

void ShapingTool::axis_from_edge(const Pointer& pointer) {
  const auto edge = edge_under(pointer);
  if (edge) return set_axis(edge->axis, edge->what);
  context_.notices.say(Notice::Kind::information, "Point at a shell: the axis is the edge nearest to the pointer.");
}

void ShapingTool::axis_from_deck(DeckAxis axis) {
  if (anchor_) set_axis(Axis{anchor_->at, unit(axis)}, std::string(kDeckAxisNames[static_cast<std::size_t>(axis)]));
}

bool ShapingTool::leave_mode() {
  if (!axis_pick_.active()) return false;
  axis_pick_.cancel();
  return true;
}

bool ShapingTool::take_back() {
  if (!axis_) return false;
  set_axis(std::nullopt, "none");
  return true;
}

// --- the direction of the falloff ---

void ShapingTool::set_falloff(const FalloffDirection& along) {
  if (picks_ == TwoNodes::falloff) axis_pick_.cancel();
  options_.along = along;
  context_.follow_soon = true;
  const mesh::Vec3& way = along.direction;
  context_.trace.line(along.in_all() ? "falloff all ways"
                                     : fmt::format("falloff along {} {} {} {}", along.what, way.x(), way.y(), way.z()));
}

void ShapingTool::falloff_from_edge(const Pointer& pointer) {
  const auto edge = edge_under(pointer);
  if (edge) return set_falloff(picked_falloff(edge->what, edge->axis.direction));
  context_.notices.say(Notice::Kind::information, "Point at a shell: the falloff goes along the edge nearest to the pointer.");
}

// --- options ---

void ShapingTool::next_handle() {
  if (pull_ || axis_) return;
  handle_ = handle_ == Under::lift_handle ? Under::slide_handle : handle_ == Under::slide_handle ? Under::move_handle : Under::lift_handle;
}

void ShapingTool::change_option(ShapingCommand command) {
  using mesh::shape::Origin;
  using mesh::shape::Profile;
  switch (command) {
    case ShapingCommand::rigid: turn_rigid(options_); break;
    case ShapingCommand::falloff:
      options_.profile = static_cast<Profile>((static_cast<int>(options_.profile) + 1) % (static_cast<int>(Profile::gaussian) + 1));
      break;
    case ShapingCommand::flatter: options_.flat = std::min(1.0, std::round((options_.flat + kFlatStep) * 100) / 100); break;
    case ShapingCommand::less_flat: options_.flat = std::max(0.0, std::round((options_.flat - kFlatStep) * 100) / 100); break;
    case ShapingCommand::free_ends: options_.free_ends = next(options_.free_ends); break;
    case ShapingCommand::origin: options_.origin = options_.origin == Origin::grab ? Origin::free_edge : Origin::grab; break;
    case ShapingCommand::each_normal: options_.each_normal = !options_.each_normal; break;
    case ShapingCommand::symmetry: options_.symmetry = next(options_.symmetry); break;
    case ShapingCommand::across_welds: options_.across_welds = !options_.across_welds; break;
    case ShapingCommand::keep_apart: context_.keeps_apart = options_.keep_apart = !options_.keep_apart; break;
    case ShapingCommand::move_limit: type_for(Typing::For::move_limit, options_.max_move); break;
    case ShapingCommand::symmetry_place: type_for(Typing::For::symmetry_place, options_.symmetry_place); break;
    default: break;
  }
  context_.follow_soon = true;
}

void ShapingTool::type_for(Typing::For what, const std::optional<double>& now) {
  typing_ = {what, now ? fmt::format("{}", *now) : std::string(), {}};
  toolkit::open_dialog(context_, this);
}

/// Takes a number for an option; nothing takes the number away.
void ShapingTool::enter_option(const std::string& text) {
  const Result<std::vector<double>> numbers = input::parse_numbers(text);
  const bool limit = typing_.what == Typing::For::move_limit, off = input::is_blank(text);
  if (!off && (!numbers || numbers->size() != 1 || (limit && !(numbers->front() > 0)))) {
    typing_.problem = !numbers ? numbers.error().message
                      : limit  ? "type one number greater than 0, or nothing"
                               : "type one number, or nothing";
    return;
  }
  (limit ? options_.max_move : options_.symmetry_place) = off ? std::nullopt : std::optional(numbers->front());
  toolkit::close_dialog(context_);
}

}  // namespace prismesh::kiosk::tools::shaping

// What keys, menu and panels ask of the editor.
#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "kiosk/editor.h"

namespace prismesh::kiosk {
namespace {

using mesh::document::RegionBy;
using mesh::document::VisibilityAction;
using tools::Command;
using tools::Pixel;
using tools::Under;

constexpr double kFeatureAngleStep = 5;  ///< degrees
constexpr std::array<const char*, 4> kLeftPanelNames{"document", "quality", "comparing", "shaping"};

}  // namespace

bool Editor::command(Command command, const std::optional<Pixel>& pointer) {
  ++changes_;
  if (tools::asks_for_edit(command) && leave_older_state()) return true;
  switch (command) {
    case Command::open: open_dialog(panels::Dialog::open); return true;
    case Command::save: files_.save(save_remark()); return true;
    case Command::save_as:
      if (shown_) open_dialog(panels::Dialog::save_as);
      return true;
    case Command::save_copy:
      if (shown_) open_dialog(panels::Dialog::save_copy);
      return true;
    case Command::undo: send(mesh::document::Undo{}); return true;
    case Command::redo: send(mesh::document::Redo{}); return true;
    case Command::compare: compare(); return true;
    case Command::cancel: cancel(); return true;
    case Command::menu: toggle_cover(Cover::menu); return true;
    case Command::help: toggle_cover(Cover::help); return true;
    case Command::deck_warnings:
      if (shown_) toggle_cover(Cover::warnings);
      return true;
    case Command::fullscreen:
    case Command::rearm: return false;
    default:
      return compare_command(command) || select_command(command, pointer) || shape_command(command, pointer) ||
             quality_command(command, pointer) || view_command(command);
  }
}

Editor::LeftPanel Editor::left_panel() const {
  return comparing_.panel_open() ? LeftPanel::comparing
         : review_.open          ? LeftPanel::quality
         : shaping_open_         ? LeftPanel::shaping
                                 : LeftPanel::document;
}

/// There is one panel at the left: what is opened takes the other's place.
void Editor::show_left(LeftPanel panel) {
  comparing_.open_panel(panel == LeftPanel::comparing);
  shaping_open_ = panel == LeftPanel::shaping;
  review_.open = panel == LeftPanel::quality;
  if (!review_.open) leave_error();
  trace_.line(std::string("panel ") + kLeftPanelNames[static_cast<std::size_t>(panel)]);
  follow_quality();
  follow_soon();
}

bool Editor::select_command(Command command, const std::optional<Pixel>& pointer) {
  switch (command) {
    case Command::expression: open_expression(); return true;
    case Command::outline_kind: lasso_ = !lasso_; return true;
    case Command::toggle_through: through_ = !through_; return true;
    case Command::grow: send(mesh::document::Grow{}); return true;
    case Command::shrink: send(mesh::document::Shrink{}); return true;
    case Command::invert: send(mesh::document::Invert{}); return true;
    case Command::region:
      if (pointer) select_region(*pointer, mesh::document::SelectMode::set);
      return true;
    case Command::region_by: region_by_ = static_cast<RegionBy>((static_cast<int>(region_by_) + 1) % 4); return true;
    case Command::wider_angle: change_angle(kFeatureAngleStep); return true;
    case Command::narrower_angle: change_angle(-kFeatureAngleStep); return true;
    case Command::region_across_welds: region_across_welds_ = !region_across_welds_; return true;
    case Command::hide: set_parts(VisibilityAction::hide, pointer); return true;
    case Command::only: set_parts(VisibilityAction::only, pointer); return true;
    case Command::lock: set_parts(VisibilityAction::lock, pointer); return true;
    case Command::unlock: set_parts(VisibilityAction::unlock, pointer); return true;
    case Command::reverse: set_parts(VisibilityAction::reverse, std::nullopt); return true;
    case Command::show_all: show_all(); return true;
    case Command::hide_file:
    case Command::only_file:
    case Command::lock_file: set_file(command, pointer); return true;
    default: return false;
  }
}

bool Editor::shape_command(Command command, const std::optional<Pixel>& pointer) {
  switch (command) {
    case Command::type_number: begin_number({}, std::nullopt); return true;
    case Command::next_tool:
      if (!pull_ && !axis_)
        tool_ = tool_ == Under::lift_handle ? Under::slide_handle : tool_ == Under::slide_handle ? Under::move_handle : Under::lift_handle;
      return true;
    case Command::pick_axis: pick_axis(); return true;
    case Command::axis_edge: axis_from_edge(pointer); return true;
    case Command::axis_x: axis_from_deck(tools::DeckAxis::x); return true;
    case Command::axis_y: axis_from_deck(tools::DeckAxis::y); return true;
    case Command::axis_z: axis_from_deck(tools::DeckAxis::z); return true;
    case Command::no_axis: set_axis(std::nullopt, "none"); return true;
    case Command::shaping_panel: toggle_left(LeftPanel::shaping); return true;
    default: return change_shaping(command);
  }
}

bool Editor::view_command(Command command) {
  switch (command) {
    case Command::fit: fit(); return true;
    case Command::view_front: look("front"); return true;
    case Command::view_back: look("back"); return true;
    case Command::view_left: look("left"); return true;
    case Command::view_right: look("right"); return true;
    case Command::view_top: look("top"); return true;
    case Command::view_bottom: look("bottom"); return true;
    case Command::view_oblique: look("iso"); return true;
    case Command::colour_mode:
      if (tools::CompareWish wish = comparing_.wish(); !wish.field.empty()) {
        wish.field.clear();  // back to the colours before
        return compare_action(panels::SetCompare{wish});
      }
      colour_ = colour_ == render::ColourMode::parts     ? render::ColourMode::quality
                : colour_ == render::ColourMode::quality ? render::ColourMode::part_states
                                                         : render::ColourMode::parts;
      return true;
    case Command::shadows: shadows_ = !shadows_; return true;
    case Command::next_profile: next_profile(); return true;
    case Command::selection_to_plane: bring_selection(); return true;
    case Command::keep_selection_in_plane:
      depth_.keep_selection(!depth_.keeps_selection());
      if (depth_.keeps_selection()) bring_selection();
      return true;
    case Command::more_depth: depth_.change_percent(1); return true;
    case Command::less_depth: depth_.change_percent(-1); return true;
    case Command::wider_comfort: depth_.change_degrees(1); return true;
    case Command::narrower_comfort: depth_.change_degrees(-1); return true;
    default: return false;
  }
}

void Editor::open_dialog(panels::Dialog dialog) {
  dialog_ = dialog;
  cover(Cover::none);
}

void Editor::cover(Cover cover) {
  if (cover == cover_) return;
  const bool listed = std::exchange(cover_, cover) == Cover::warnings;
  if (listed) trace_.line("warnings closed");
  if (cover != Cover::warnings) return;
  notices_.read_warnings();
  const std::size_t errors = tools::error_count(link_.warnings());
  trace_.line(fmt::format("warnings shown errors {} warnings {}", errors, link_.warnings().size() - errors));
}

bool Editor::reply_by_key(display::Key key) {
  const std::optional<tools::Reply> reply = files_.reply_of(key);
  if (!reply || *reply == tools::Reply::cancel) return false;
  files_.reply(*reply);
  ++changes_;
  return true;
}

/// What lies on top goes first.
void Editor::cancel() {
  if (link_.can_stop()) return link_.stop();
  if (pull_ || rubber_band_ || !lasso_way_.empty()) return cancel_gesture();
  if (files_.question())
    files_.reply(tools::Reply::cancel);
  else if (dialog_ != panels::Dialog::none)
    dialog_ = panels::Dialog::none;
  else if (cover_ != Cover::none)
    cover(Cover::none);
  else if (axis_pick_.active())
    axis_pick_.cancel();
  else if (by_hand_.operation)
    leave_operation();
  else if (!notices_.empty())
    notices_.read();
  else if (before_after_.end())
    follow_soon();
  else if (axis_)
    set_axis(std::nullopt, "none");
  else
    clear_selection();
}

void Editor::look(std::string_view view_name) {
  if (const auto rotation = stereo::named_rotation(view_name)) view_.rotation = *rotation;
  fit();
}

void Editor::fit() {
  if (renderer_.bounds().empty()) return;
  Eigen::Vector2d free = stereo::screen_size_mm(profile_, size_.width, size_.height);
  free.x() *= std::max(0.2, 1 - covered_width_ / std::max(size_.width, 1));
  if (comparing_.two_views()) free.x() *= 0.5;
  view_ = renderer_.fitted(view_, free, seen_.between_eyes_mm.z());
  if (depth_.keeps_selection()) bring_selection();
  view_moved();
  ++changes_;
}

void Editor::next_profile() {
  const auto profiles = stereo::built_in_profiles();
  const auto current = std::find_if(profiles.begin(), profiles.end(), [&](const stereo::Profile& p) { return p.name == profile_.name; });
  profile_ = current == profiles.end() || current + 1 == profiles.end() ? profiles.front() : *(current + 1);
  view_moved();
  trace_.line("profile " + profile_.name);
}

void Editor::panel_action(const panels::PanelAction& action) {
  ++changes_;
  if (quality_action(action) || compare_action(action)) return;
  if (const auto* ask = std::get_if<panels::AskParts>(&action)) {
    mesh::document::SetParts edit;
    edit.action = ask->action;
    edit.on = ask->on;
    send(std::move(edit));
  } else if (const auto* open = std::get_if<panels::AskOpen>(&action)) {
    files_.open(open->path);
  } else if (const auto* save = std::get_if<panels::AskSave>(&action)) {
    files_.save_elsewhere(save->path, save->copy ? DeckFiles::Elsewhere::copy : DeckFiles::Elsewhere::becomes, save_remark());
  } else if (const auto* reply = std::get_if<tools::Reply>(&action)) {
    files_.reply(*reply);
  } else if (std::holds_alternative<panels::NoticeRead>(action)) {
    if (!notices_.empty()) notices_.read();
  } else if (std::holds_alternative<panels::DialogClosed>(action)) {
    dialog_ = panels::Dialog::none;
  } else if (const auto* typed = std::get_if<panels::ExpressionTyped>(&action)) {
    expression_changed(*typed);
  } else if (const auto* entered = std::get_if<panels::ExpressionEntered>(&action)) {
    enter_expression(*entered);
  } else if (const auto* number = std::get_if<panels::NumberEntered>(&action)) {
    enter_number(number->text);
  } else if (const auto* shaping = std::get_if<panels::SetShaping>(&action)) {
    shaping_ = shaping->options;
  } else if (const auto* region = std::get_if<panels::SetRegion>(&action)) {
    region_by_ = region->by;
    region_across_welds_ = region->across_welds;
    if (region->angle != region_angle_) change_angle(region->angle - region_angle_);
  } else if (const auto* asked = std::get_if<Command>(&action)) {
    if (cover_ == Cover::menu) cover(Cover::none);
    command(*asked, std::nullopt);
  }
}

}  // namespace prismesh::kiosk

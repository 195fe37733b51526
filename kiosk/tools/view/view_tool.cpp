#include "kiosk/tools/view/view_tool.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kiosk/toolkit/edits.h"
#include "kiosk/toolkit/model_boxes.h"
#include "kiosk/toolkit/picking.h"
#include "kiosk/toolkit/tool_set.h"
#include "kiosk/toolkit/words_on_thickness.h"
#include "kiosk/tools/view/colour_key.h"
#include "kiosk/tools/view/view_keys.h"

namespace prismesh::kiosk::tools::view {
namespace {

using input::Orbited;
using input::Panned;
using input::Zoomed;
using panels::PanelLayout;
using toolkit::DepthFit;
using toolkit::PictureView;

constexpr double kZoomPerStep = 1.15;

std::vector<std::string> profile_names() {
  std::vector<std::string> names;
  for (const stereo::Profile& profile : stereo::built_in_profiles()) names.push_back(profile.name);
  return names;
}

}  // namespace

std::span<const input::KeyBinding> keys() { return kKeys; }

std::string_view ViewTool::name() const { return kName; }

void ViewTool::command(std::uint8_t number, const toolkit::Pointer&) {
  DepthFit& depth = context_.view.depth;
  switch (static_cast<ViewCommand>(number)) {
    case ViewCommand::fit: fit(); break;
    case ViewCommand::fit_model: fit_model(); break;
    case ViewCommand::front: look_from("front"); break;
    case ViewCommand::back: look_from("back"); break;
    case ViewCommand::left: look_from("left"); break;
    case ViewCommand::right: look_from("right"); break;
    case ViewCommand::top: look_from("top"); break;
    case ViewCommand::bottom: look_from("bottom"); break;
    case ViewCommand::oblique: look_from("iso"); break;
    case ViewCommand::colour_mode: next_colours(); break;
    case ViewCommand::shadows: context_.view.shadows = !context_.view.shadows; break;
    case ViewCommand::thickness: turn_thickness(); break;
    case ViewCommand::next_profile: next_profile(); break;
    case ViewCommand::selection_to_plane: toolkit::bring_selection(context_); break;
    case ViewCommand::keep_selection_in_plane: keep_selection(!depth.keeps_selection()); break;
    case ViewCommand::more_depth: depth.change_percent(1); break;
    case ViewCommand::less_depth: depth.change_percent(-1); break;
    case ViewCommand::wider_comfort: depth.change_degrees(1); break;
    case ViewCommand::narrower_comfort: depth.change_degrees(-1); break;
  }
}

// --- gestures ---

bool ViewTool::gesture(const input::Gesture& gesture) {
  if (const auto* orbited = std::get_if<Orbited>(&gesture))
    orbit(*orbited);
  else if (const auto* panned = std::get_if<Panned>(&gesture))
    pan(*panned);
  else if (const auto* zoomed = std::get_if<Zoomed>(&gesture))
    zoom(*zoomed);
  else
    return false;
  return true;
}

void ViewTool::orbit(const Orbited& orbit) {
  PictureView& view = context_.view;
  if (orbit_from_ != orbit.from) {
    // The model turns about what was under the pointer when the drag began.
    orbit_from_ = orbit.from;
    const auto node = toolkit::shown_node_at(context_, toolkit::in_picked_view(view, orbit.from));
    if (node) view.view = stereo::with_pivot(view.view, context_.shown.snapshot->position(node->value));
  }
  const double radians_per_pixel = std::numbers::pi / std::max(view.size.height, 1);
  view.view = stereo::orbit(view.view, orbit.dx * radians_per_pixel, -orbit.dy * radians_per_pixel);
  context_.tools.view_moved(orbit.at);
}

void ViewTool::pan(const Panned& pan) {
  PictureView& view = context_.view;
  if (!panned_ || panned_->from != pan.from) {
    const auto node = toolkit::shown_node_at(context_, toolkit::in_picked_view(view, pan.from));
    panned_ = Held{pan.from, node ? std::optional(context_.shown.snapshot->position(node->value)) : std::nullopt};
  }
  // What was under the pointer where the drag began stays under it: what is nearer than the screen moves less far to seem to move as far.
  const stereo::Aim aim = toolkit::aim(view);
  const double before_mm = panned_->point ? stereo::to_screen(aim.view, *panned_->point).z() : 0;
  const double nearer = std::clamp((aim.eye_mm.z() - before_mm) / std::max(aim.eye_mm.z(), 1.0), 0.1, 10.0);
  view.view = stereo::pan(view.view, Eigen::Vector2d(pan.dx, -pan.dy) * aim.mm_per_pixel() * nearer);
  context_.tools.view_moved(pan.at);
}

void ViewTool::zoom(const Zoomed& zoom) {
  PictureView& view = context_.view;
  Eigen::Vector2d place = stereo::mm_of_pixel(toolkit::aim(view), zoom.at);
  if (view.two_views) place.x() -= (toolkit::is_beside(view, zoom.at) ? -1 : 1) * toolkit::pane_shift_mm(view);
  view.view = stereo::zoom(view.view, std::pow(kZoomPerStep, zoom.steps), place);
  context_.tools.view_moved();
}

// --- commands ---

void ViewTool::look_from(std::string_view side) {
  if (const auto rotation = stereo::named_rotation(side)) context_.view.view.rotation = *rotation;
  fit_model();
}

void ViewTool::fit() {
  const stereo::Box selection = context_.shown.older ? stereo::Box() : toolkit::turned_box_of_selection(context_);
  if (selection.empty()) return fit_model();
  PictureView& view = context_.view;
  set_view(stereo::fit_turned(view.view, selection, toolkit::room_of_view_mm(view), view.seen.between_eyes_mm.z()));
}

void ViewTool::fit_model() {
  if (context_.renderer.bounds().empty()) return;
  PictureView& view = context_.view;
  set_view(context_.renderer.fitted(view.view, toolkit::room_of_view_mm(view), view.seen.between_eyes_mm.z()));
}

void ViewTool::set_view(const stereo::View& view) {
  context_.view.view = view;
  if (context_.view.depth.keeps_selection()) toolkit::bring_selection(context_);
  context_.tools.view_moved();
  ++context_.changes;
}

void ViewTool::next_colours() {
  if (context_.tools.leave_colours()) return;  // back to the colours before
  using render::ColourMode;
  ColourMode& colour = context_.view.colour;
  colour = colour == ColourMode::parts ? ColourMode::quality : colour == ColourMode::quality ? ColourMode::part_states : ColourMode::parts;
}

void ViewTool::turn_thickness() {
  context_.view.thickness = !context_.view.thickness;
  context_.trace.line(context_.view.thickness ? "thickness on" : "thickness off");
}

/// What the picture doesn't show of the thickness; empty: it shows all.
std::string ViewTool::words_on_thickness() const {
  const auto& shown = context_.shown.snapshot;
  return context_.view.thickness && shown ? toolkit::words_on_thickness(shown->info().parts) : std::string();
}

void ViewTool::next_profile() {
  const std::vector<std::string> names = profile_names();
  const auto current = std::ranges::find(names, context_.view.profile.name);
  take_profile(current == names.end() || current + 1 == names.end() ? names.front() : *(current + 1));
}

void ViewTool::take_profile(const std::string& name) {
  const auto profiles = stereo::built_in_profiles();
  const auto found = std::ranges::find(profiles, name, &stereo::Profile::name);
  if (found == profiles.end()) return;
  context_.view.profile = *found;
  context_.tools.view_moved();
  context_.trace.line("profile " + name);
}

void ViewTool::keep_selection(bool keep) {
  context_.view.depth.keep_selection(keep);
  if (keep) toolkit::bring_selection(context_);
}

// --- following ---

Result<void> ViewTool::prepare() {
  if (!shared_.take()) return {};
  context_.tools.view_moved();
  context_.trace.line("view follows");
  return {};
}

void ViewTool::look(std::int64_t now_ns) {
  shared_.share();
  PictureView& view = context_.view;
  const stereo::View fitted = view.depth.fitted(view.glide.along(view.view, now_ns), view.seen.between_eyes_mm, now_ns);
  if (fitted == view.view) return;
  view.view = fitted;
  ++context_.changes;
}

// --- panels ---

void ViewTool::draw_tab(PanelLayout& layout) {
  const std::string others = context_.tools.colours();
  const char* own = context_.view.colour == render::ColourMode::quality       ? "quality"
                    : context_.view.colour == render::ColourMode::part_states ? "parts' state"
                                                                              : "part";
  thickness_section(context_.view.thickness, words_on_thickness(), layout);
  if (const auto chosen = picture_section(others.empty() ? own : others, context_.view.profile.name, profile_names(), layout))
    layout.ask([this, name = *chosen] { take_profile(name); });
  stereo_sections(stereo_facts(), layout);
}

void ViewTool::draw_over_picture(PanelLayout& layout) {
  if (context_.shown.snapshot && context_.tools.colours().empty()) colour_key(context_.view.colour, layout);
}

/// The display's profiles by name, in the menu of the display.
void ViewTool::draw_menu_entries(input::Menu menu, PanelLayout& layout) {
  if (menu != input::Menu::display) return;
  if (const auto chosen = profile_entries(context_.view.profile.name, profile_names(), layout))
    layout.ask([this, name = *chosen] { take_profile(name); });
}

StereoFacts ViewTool::stereo_facts() const {
  const DepthFit& depth = context_.view.depth;
  StereoFacts facts;
  facts.eyes = context_.view.eyes;
  if (context_.view.profile.stereo()) facts.depth = DepthFacts{depth.percent(), depth.degrees(), depth.keeps_selection()};
  return facts;
}

}  // namespace prismesh::kiosk::tools::view

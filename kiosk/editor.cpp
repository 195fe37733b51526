#include "kiosk/editor.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace prismesh::kiosk {
namespace {

using panels::Notice;

constexpr double kZoomPerStep = 1.15;
constexpr double kAngleStep = 5;  ///< degrees

}  // namespace

Editor::Editor(const EditorOptions& options, ModelLink& link, render::Renderer& renderer, Clock& clock, Trace trace)
    : link_(link),
      renderer_(renderer),
      clock_(clock),
      trace_(trace),
      profile_(options.profile),
      expressions_(options.expressions),
      mouse_words_(options.mouse.in_words()),
      quality_(link),
      files_(link, trace),
      notices_(trace),
      comparing_(link, renderer, trace),
      before_after_(link, comparing_, notices_, trace),
      follows_others_(options.follows_others) {
  view_.rotation = *stereo::named_rotation("iso");
}

void Editor::set_picture_size(display::PixelSize size) {
  if (size == size_) return;
  size_ = size;
  ++changes_;
}

void Editor::look_from(const stereo::SeenFrom& seen) {
  seen_ = seen;
  const std::int64_t now = clock_.now_ns();
  share_view();
  const stereo::View fitted = depth_.fitted(glide_.along(view_, now), seen.between_eyes_mm, now);
  if (fitted == view_) return;
  view_ = fitted;
  ++changes_;
}

void Editor::set_eyes_facts(std::optional<panels::EyesFacts> facts) {
  if (facts == eyes_facts_) return;
  eyes_facts_ = std::move(facts);
  ++changes_;
}

void Editor::set_panel(const render::PanelPlace& panel) {
  if (panel == panel_) return;
  panel_ = panel;
  ++changes_;
}

/// Of the view that things are picked in: the right one of two.
stereo::Aim Editor::aim() const {
  render::Picture picture = plain_picture();
  if (comparing_.two_views())
    picture.view = stereo::pan(view_, {pane_shift() * stereo::screen_size_mm(profile_, size_.width, size_.height).x(), 0});
  return render::aim_for(picture, size_.width, size_.height);
}

// --- following the model server ---

Result<void> Editor::follow() {
  if (link_.changes() == link_changes_) return {};
  link_changes_ = link_.changes();
  ++changes_;
  notices_.follow(link_.document_number());
  files_.follow();
  if (files_.question()) cover(Cover::none);
  for (Notice& notice : link_.take_notices()) notices_.take(std::move(notice));
  take_shared_view();
  if (Result<void> followed = follow_states(); !followed) return followed;
  if (link_.snapshot() != shown_) {
    const auto& next = link_.snapshot();
    const bool other_document = next && (!shown_ || document_number_ != link_.document_number());
    document_number_ = link_.document_number();
    shown_ = next;
    // What stays within comfortable depth is what is shown now.
    if (const stereo::Box box = renderer_.bounds(); !box.empty()) view_.bounds = stereo::sphere_around(box);
    take_model();
    if (other_document) {
      axis_.reset();
      axis_pick_.cancel();
      leave_error();
      leave_operation();
      fit();
    }
  }
  follow_quality();
  return follow_drag();
}

void Editor::take_model() {
  if (!shown_) {
    anchor_.reset();
    last_clicked_.reset();
    selection_centre_.reset();
    return;
  }
  const std::optional<mesh::Vec3> centre = shown_->info().selected_nodes > 0 ? tools::selection_centre(*renderer_.model()) : std::nullopt;
  const bool elsewhere = centre != selection_centre_;
  selection_centre_ = centre;
  if (elsewhere && depth_.keeps_selection()) bring_selection();
  anchor_ = shown_->info().selected_nodes > 0 ? tools::anchor_of_selection(*renderer_.model(), last_clicked_) : std::nullopt;
}

/// The selection's middle goes into the plane of the screen, where both eyes see it at the same place.
void Editor::bring_selection() {
  if (selection_centre_ && profile_.stereo()) depth_.bring(*selection_centre_, clock_.now_ns());
}

// --- gestures that move the view ---

void Editor::gesture(const tools::Gesture& gesture) {
  ++changes_;
  const std::optional<tools::Pixel> picks = tools::picks_at(gesture);
  if (picks && beside(*picks)) return cancel_gesture();
  if (tools::asks_for_edit(gesture) && leave_older_state()) return;
  std::visit([this](const auto& what) { handle(what); }, gesture);
}

/// What is pulled stays where it has been pulled to, and the pointer on it.
void Editor::view_moved() {
  if (pull_) pull_->hold(aim(), pulled_to_, pulled_);
}

void Editor::handle(const tools::Orbited& orbit) {
  if (!pivot_found_ || orbit.from != orbit_from_) {
    // The model turns about what was under the pointer when the drag began.
    pivot_found_ = true;
    orbit_from_ = orbit.from;
    const std::optional<mesh::NodeIndex> node = shown_ ? node_at(in_picked_view(orbit.from)) : std::nullopt;
    if (node && node->value < shown_->node_count()) view_ = stereo::with_pivot(view_, shown_->position(node->value));
  }
  const double radians_per_pixel = std::numbers::pi / std::max(size_.height, 1);
  view_ = stereo::orbit(view_, orbit.dx * radians_per_pixel, -orbit.dy * radians_per_pixel);
  pulled_to_ = orbit.at;
  view_moved();
}

void Editor::handle(const tools::Panned& pan) {
  view_ = stereo::pan(view_, Eigen::Vector2d(pan.dx, -pan.dy) * aim().mm_per_pixel());
  pulled_to_ = pan.at;
  view_moved();
}

void Editor::handle(const tools::Zoomed& zoom) {
  Eigen::Vector2d place = stereo::mm_of_pixel(aim(), zoom.at);
  if (comparing_.two_views())
    place.x() -=
        (zoom.at.x() > 0.5 * size_.width ? 1 : -1) * pane_shift() * stereo::screen_size_mm(profile_, size_.width, size_.height).x();
  view_ = stereo::zoom(view_, std::pow(kZoomPerStep, zoom.steps), place);
  view_moved();
}

void Editor::handle(const tools::AngleTurned& turned) { change_angle(turned.steps * kAngleStep); }

void Editor::cancel_gesture() {
  rubber_band_.reset();
  lasso_way_.clear();
  cancel_pull();
  ++changes_;
}

}  // namespace prismesh::kiosk

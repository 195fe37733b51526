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
      mouse_words_(options.mouse.in_words()) {
  view_.rotation = *stereo::named_rotation("iso");
}

void Editor::set_picture_size(display::PixelSize size) {
  if (size == size_) return;
  size_ = size;
  ++changes_;
}

void Editor::look_from(const stereo::SeenFrom& seen) {
  seen_ = seen;
  const stereo::View fitted = depth_.fitted(view_, seen.between_eyes_mm, clock_.now_ns());
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

stereo::Aim Editor::aim() const { return render::aim_for(plain_picture(), size_.width, size_.height); }

// --- following the model server ---

Result<void> Editor::follow() {
  if (link_.changes() == link_changes_) return {};
  link_changes_ = link_.changes();
  ++changes_;
  follow_notices();
  if (link_.snapshot() != shown_) {
    const auto& next = link_.snapshot();
    const bool other_document = next && (!shown_ || shown_->info().document != next->info().document);
    if (Result<void> set = renderer_.set_model(next ? render::snapshot_source(next) : nullptr); !set) return set;
    shown_ = next;
    // What stays within comfortable depth is what is shown now.
    if (const stereo::Box box = renderer_.bounds(); !box.empty()) view_.bounds = stereo::sphere_around(box);
    take_model();
    if (other_document) {
      axis_.reset();
      axis_pick_.cancel();
      comparison_.reset();
      fit();
    }
    follow_comparison();
  }
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

void Editor::follow_notices() {
  for (Notice& notice : link_.take_notices()) {
    // Information gives way to anything newer; errors and warnings stay until they are read.
    while (!notices_.empty() && notices_.back().kind == Notice::Kind::information) notices_.pop_back();
    notices_.push_back(std::move(notice));
  }
}

/// Whether the state that is shown still is one of the two that are compared.
void Editor::follow_comparison() {
  if (!comparison_ || !shown_) return;
  const std::uint64_t now = shown_->info().generation;
  if (!comparison_->before && now == comparison_->after) return;  // the undo is on its way
  if (!comparison_->before && now != comparison_->after) comparison_->before = now;
  if (now != comparison_->after && now != comparison_->before) return comparison_.reset();
  trace_.line((now == comparison_->after ? "comparing after " : "comparing before ") + comparison_->edit);
}

// --- gestures that move the view ---

void Editor::gesture(const tools::Gesture& gesture) {
  ++changes_;
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
    const std::optional<mesh::NodeIndex> node = shown_ ? node_at(orbit.from) : std::nullopt;
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
  view_ = stereo::zoom(view_, std::pow(kZoomPerStep, zoom.steps), stereo::mm_of_pixel(aim(), zoom.at));
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

// Comparing by hand: colours by a field, two views, and views that move together.
#include <algorithm>
#include <utility>

#include "kiosk/editor.h"

namespace prismesh::kiosk {
namespace {

/// In two views each is half as large; what is told to other kiosks doesn't depend on how many there are here.
constexpr double kTwoViewsSize = 0.5;

}  // namespace

bool Editor::compare_command(tools::Command command) {
  if (command == tools::Command::compare_panel) {
    toggle_left(LeftPanel::comparing);
  } else if (command == tools::Command::two_views) {
    tools::CompareWish wish = comparing_.wish();
    wish.two_views = !wish.two_views;
    // Before and after: what was opened stands beside what is.
    if (const auto& state = link_.state(); wish.two_views && !wish.beside && state && !state->generations.empty())
      wish.beside = state->generations.front().number;
    compare_action(panels::SetCompare{wish});
  } else {
    return false;
  }
  follow_soon();
  return true;
}

bool Editor::compare_action(const panels::PanelAction& action) {
  if (const auto* limits = std::get_if<panels::SetLimits>(&action)) {
    comparing_.set_limits(*limits);
    return true;
  }
  const auto* wanted = std::get_if<panels::SetCompare>(&action);
  if (wanted == nullptr) return false;
  cancel_gesture();
  const bool two = comparing_.two_views();
  comparing_.set(wanted->wish);
  if (two && !comparing_.two_views()) resize_view(1 / kTwoViewsSize);
  follow_soon();
  return true;
}

/// The state before the last edit, or the newest one again.
void Editor::compare() {
  if (!shown_ || pull_) return;
  leave_operation();  // its preview is of the newest state
  before_after_.toggle();
  follow_soon();
}

/// All edits go this way: none is made in a state that isn't the newest.
void Editor::send(mesh::document::Edit edit) {
  if (leave_older_state()) return;
  comparing_.show_current();  // also once there is another one
  link_.edit(std::move(edit));
}

/// Shows the newest state in place of an older one, and says that nothing was edited. False: the newest one is shown already.
bool Editor::leave_older_state() {
  if (!comparing_.shows_older()) return false;
  const std::string which = before_after_.shows_before() ? "the state before " + before_after_.edit() : "an older state";
  before_after_.end();
  comparing_.show_current();
  cancel_gesture();
  follow_soon();
  notices_.say(panels::Notice::Kind::information,
               "You were looking at " + which + ". This is the newest state; nothing was edited. Ask again to edit it.");
  return true;
}

std::string Editor::save_remark() const {
  return comparing_.shows_older() ? "It is the newest state that was saved, not the older one that is shown." : "";
}

/// Gives the renderer the state that is wanted.
Result<void> Editor::follow_states() {
  const bool two = comparing_.two_views();
  before_after_.follow();
  if (Result<void> followed = comparing_.follow(); !followed) return followed;
  if (const auto wanted = comparing_.model(); wanted != drawn_ || (wanted && comparing_.hidden() != drawn_hidden_)) {
    if (Result<void> set = renderer_.set_model(wanted ? render::snapshot_source(wanted, comparing_.hidden()) : nullptr); !set) return set;
    drawn_ = wanted;
    drawn_hidden_ = comparing_.hidden();
    if (shown_ && link_.snapshot() == shown_) take_model();
  }
  before_after_.tell();
  if (two != comparing_.two_views() && shown_) resize_view(two ? 1 / kTwoViewsSize : kTwoViewsSize);
  return {};
}

/// What one looked at is looked at in both of two views, and again in the one.
void Editor::resize_view(double by) {
  view_.mm_per_unit *= by;
  view_.pan_mm *= by;
  view_moved();
}

/// How far each of two views stands from the middle: in the middle of what panels leave of its half.
double Editor::pane_shift() const { return 0.25 * std::max(0.2, 1 - covered_width_ / std::max(size_.width, 1)); }

/// In the left one of two views: what is there is only shown.
bool Editor::beside(const tools::Pixel& pixel) const { return comparing_.two_views() && pixel.x() <= 0.5 * size_.width; }

/// What is there in the left one of two views is in the right one too, unless it came or went in between.
tools::Pixel Editor::in_picked_view(const tools::Pixel& pixel) const {
  const bool left = comparing_.two_views() && pixel.x() < 0.5 * size_.width;
  return left ? tools::Pixel(pixel.x() + 2 * pane_shift() * size_.width, pixel.y()) : pixel;
}

void Editor::share_view() {
  if (!follows_others_ || !shown_) return;
  ipc::Camera camera;
  camera.pivot = {view_.pivot.x(), view_.pivot.y(), view_.pivot.z()};
  camera.rotation = {view_.rotation.w(), view_.rotation.x(), view_.rotation.y(), view_.rotation.z()};
  const double size = comparing_.two_views() ? kTwoViewsSize : 1;
  camera.mm_per_unit = view_.mm_per_unit / size;
  camera.stands_mm = {view_.pan_mm.x() / size, view_.pan_mm.y() / size, view_.before_mm};
  if (shared_ == camera) return;
  // Whoever comes last doesn't move the others by coming.
  if (std::exchange(shared_, camera)) link_.share_camera(camera);
}

void Editor::take_shared_view() {
  const std::optional<ipc::Camera> heard = link_.take_camera();
  if (!heard || !follows_others_ || heard->rotation.size() != 4 || !(heard->mm_per_unit > 0)) return;
  const Eigen::Quaterniond rotation(heard->rotation[0], heard->rotation[1], heard->rotation[2], heard->rotation[3]);
  if (!(rotation.norm() > 0.5 && rotation.norm() < 2)) return;
  view_.pivot = {heard->pivot[0], heard->pivot[1], heard->pivot[2]};
  view_.rotation = rotation.normalized();
  const double size = comparing_.two_views() ? kTwoViewsSize : 1;
  view_.mm_per_unit = size * heard->mm_per_unit;
  view_.pan_mm = size * Eigen::Vector2d(heard->stands_mm[0], heard->stands_mm[1]);
  view_.before_mm = heard->stands_mm[2];
  shared_ = heard;
  shared_->rotation = {view_.rotation.w(), view_.rotation.x(), view_.rotation.y(), view_.rotation.z()};
  view_moved();
  trace_.line("view follows");
}

}  // namespace prismesh::kiosk

// The pulls of the shaping tool: from taking the handle, or typing a number, until the server has the edit.
#include <utility>

#include <fmt/format.h>

#include "kiosk/input/typed_numbers.h"
#include "kiosk/toolkit/open_panels.h"
#include "kiosk/toolkit/picking.h"
#include "kiosk/toolkit/tool_set.h"
#include "kiosk/tools/shaping/shaping_tool.h"
#include "kiosk/tools/shaping/typed_number.h"

namespace prismesh::kiosk::tools::shaping {

using input::Pixel;
using input::Under;
using link::RunningDrag;
using toolkit::Pointer;

void ShapingTool::begin_pull(Under handle, const Pixel& at) {
  if (!anchor_ || context_.link.drag.running() != nullptr || !context_.tools.allow_edit()) return;
  const bool turning = handle == Under::turn_handle;
  if (turning && !axis_) return;
  const ShapedHandle shaped{handle, anchor_->id, context_.selection.centre.value_or(anchor_->at), axis_};
  const mesh::document::Edit edit = edit_of(shaped, options_, {});
  if (context_.tools.hold(edit, false)) return;
  context_.tools.leave_previews();
  context_.tools.edit_begins();
  const stereo::Aim now = toolkit::aim(context_.view);
  HandleGrab grab;
  grab.handle = handle;
  grab.at = turning ? ball_place(now, *axis_, anchor_->at) : anchor_->at;
  grab.direction = arrow_direction(now, *anchor_);
  if (turning) grab.axis = axis_;
  grab.pixel = at;
  pull_ = ActivePull{HandlePull(grab, now), at};
  pull_->options = options_;
  handle_ = handle;
  pulled_ = {};
  context_.link.drag.begin(edit);
  if (context_.link.drag.running() == nullptr) pull_.reset();
}

void ShapingTool::pull_to(const Pixel& pixel) {
  pull_->pointer = pixel;
  pulled_ = pull_->pull.at(toolkit::aim(context_.view), pixel, pulled_);
  if (pull_->axis_known) context_.link.drag.pull(pulled_);
}

/// The preview, and the edit once they are entered, get exactly the numbers that were typed.
void ShapingTool::send_typed() {
  if (!pull_ || !pull_->typed || !pull_->axis_known) return;
  pulled_ = *pull_->typed;
  if (pull_->pull.handle() == Under::lift_handle) pulled_.distance = pull_->pull.lift_of(pull_->typed->distance);
  context_.link.drag.pull(pulled_);
  if (pull_->entered) context_.link.drag.commit();
}

void ShapingTool::cancel_gesture() {
  if (ring_drag_) {
    ring_drag_.reset();
    options_.flat = flat_before_;
    context_.follow_soon = true;
    ++context_.changes;
    return;
  }
  if (!dragging()) return;
  pull_.reset();
  if (is_typing() && typing_.what == Typing::For::pull) toolkit::close_dialog(context_);
  context_.link.drag.cancel();
  ++context_.changes;
}

/// The pull stays as it is, and the pointer stays on it.
void ShapingTool::view_moved(const Pointer& pointer) {
  if (!pull_) return;
  if (pointer) pull_->pointer = *pointer;
  pull_->pull.hold(toolkit::aim(context_.view), pull_->pointer, pulled_);
}

Result<void> ShapingTool::follow() {
  const RunningDrag* drag = context_.link.drag.running();
  if (drag == nullptr) {
    if (pull_ && pull_->by_number && !pull_->entered) {
      pulled_ = typing_.from;
      typing_.refused = true;
    }
    pull_.reset();
  } else if (drag->begun() && pull_ && !pull_->axis_known) {
    take_axis(*drag);
  }
  follow_typing();
  ask_followed_edges();
  return preview_.follow();
}

/// During a pull the last answer stays: it was of the same edit.
void ShapingTool::ask_followed_edges() {
  const link::ModelLink& link = context_.link;
  if (pull_ || link.drag.running() != nullptr || !link.connection.connected() || !link.document.up_to_date() || context_.shown.older ||
      !context_.shown.snapshot)
    return;
  const ipc::SnapshotInfo& info = context_.shown.snapshot->info();
  std::optional<mesh::document::Edit> edit;
  if (anchor_ && info.selected_nodes <= kMaxSelectionToAsk)
    edit = edit_of({axis_ ? Under::turn_handle : Under::move_handle, anchor_->id, anchor_->at, axis_}, options_, {});
  followed_.ask(edit, info.generation);
}

/// The server has told the grab and the normal: what was pulled or typed meanwhile goes to it.
void ShapingTool::take_axis(const RunningDrag& drag) {
  const ipc::DragBegun& facts = drag.facts();
  pull_->pull.set_axis(toolkit::aim(context_.view), mesh::Vec3(facts.grab_position[0], facts.grab_position[1], facts.grab_position[2]),
                       mesh::Vec3(facts.normal[0], facts.normal[1], facts.normal[2]));
  pull_->axis_known = true;
  if (pull_->typed)
    send_typed();
  else
    pull_to(pull_->pointer);
  if (pull_->released_early && !pull_->typed) context_.link.drag.commit();
}

// --- numbers ---

bool ShapingTool::takes_numbers(const Pointer& pointer) const {
  if (pull_) return true;
  // A click leaves the pointer on the ring, where digits must still choose views.
  const Under part = pointer ? under(*pointer) : Under::picture;
  return part != Under::picture && part != Under::move_handle;
}

bool ShapingTool::begin_number(const std::string& text, const Pointer& pointer) {
  if (!anchor_ && !pull_) return false;
  if (pull_)
    handle_ = pull_->pull.handle();
  else if (const Under part = pointer ? under(*pointer) : Under::picture; part != Under::picture)
    handle_ = part;
  else if ((handle_ == Under::turn_handle) != axis_.has_value())
    handle_ = axis_ ? Under::turn_handle : Under::lift_handle;
  typing_ = {Typing::For::pull, text};
  typing_.at = pull_ ? context_.hand.at : pointer;
  typing_.from = pulled_;
  toolkit::open_dialog(context_, this);
  return true;
}

/// Where a number that is typed goes; nothing: see typed_hint.
std::optional<Vec3> ShapingTool::typed_direction() const {
  const std::optional<Axis>& axis = pull_ ? pull_->pull.axis() : axis_;
  switch (handle_) {
    case Under::turn_handle: return axis ? std::optional(axis->direction) : std::nullopt;
    case Under::slide_handle:
    case Under::move_handle: return typing_.from.by.norm() > 0 ? std::optional(Vec3(typing_.from.by.normalized())) : std::nullopt;
    default: break;
  }
  if (options_.each_normal || (!pull_ && !anchor_)) return std::nullopt;
  return pull_ ? pull_->pull.direction() : arrow_direction(toolkit::aim(context_.view), *anchor_);
}

void ShapingTool::enter_number(const std::string& text) {
  if (typing_.what == Typing::For::pull)
    enter_pull(text);
  else
    enter_option(text);
}

void ShapingTool::enter_pull(const std::string& text) {
  const Result<Pull> typed = typed_displacement(handle_, text, typing_.from);
  if (!typed) {
    typing_.problem = typed.error().message;
    return;
  }
  if (!pull_ && context_.link.drag.running() != nullptr) return;  // a preview is ending: the box stays until the edit can begin
  toolkit::close_dialog(context_);
  context_.trace.line(fmt::format("typed {} {}", name_of(handle_), text));
  if (!pull_) begin_pull(handle_, Pixel::Zero());
  if (!pull_) return;
  pull_->typed = *typed;
  pull_->entered = true;
  send_typed();
}

// --- the preview of a number that is being typed ---

bool ShapingTool::wants_preview(const std::string& text) const {
  return !typing_.refused && typing_.previewed != text && (pull_ || context_.link.drag.running() == nullptr);
}

/// Shows what the number would do. A text that is no number yet leaves what is shown; an empty one takes it back.
void ShapingTool::preview_number(const std::string& text) {
  typing_.previewed = text;
  Pull shown;
  if (input::is_blank(text)) {
    if (!pull_) return;
    if (!pull_->by_number) shown = typing_.from;
    if (pull_->pull.handle() == Under::lift_handle) shown.distance = pull_->pull.along_arrow(shown);
  } else if (const Result<Pull> typed = typed_displacement(handle_, text, typing_.from)) {
    shown = *typed;
  } else {
    return;
  }
  if (!pull_) {
    // The user is asked at Enter, not in the middle of a number.
    if (!anchor_ || context_.tools.would_hold(edit_of({handle_, anchor_->id, anchor_->at, axis_}, options_, {}))) return;
    begin_pull(handle_, Pixel::Zero());
    if (!pull_) return;
    pull_->by_number = true;
  }
  pull_->typed = shown;
  send_typed();
}

void ShapingTool::end_number_preview() {
  pull_.reset();
  pulled_ = typing_.from;
  context_.link.drag.cancel();
  ++context_.changes;
}

/// Another edit or another preview begins.
void ShapingTool::leave_preview() {
  if (pull_ && pull_->by_number && !pull_->entered) end_number_preview();
}

/// A preview goes with the box. Other options make another one.
void ShapingTool::follow_typing() {
  if (!pull_ || !pull_->typed || pull_->entered) return;
  const bool other = pull_->by_number && pull_->options != options_;
  if (types_pull() && !other) return;
  end_number_preview();
  typing_.previewed.reset();
}

}  // namespace prismesh::kiosk::tools::shaping

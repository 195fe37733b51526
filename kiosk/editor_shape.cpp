// The editor's pulling: the handle and its parts, axes to turn about, numbers that are typed, and what fades out how.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "kiosk/editor.h"

namespace prismesh::kiosk {
namespace {

using panels::Notice;
using tools::Command;
using tools::Pixel;
using tools::Under;
using Use = render::Handle::Use;

Use use_of(Under handle) {
  switch (handle) {
    case Under::slide_handle: return Use::disk;
    case Under::move_handle: return Use::ring;
    case Under::turn_handle: return Use::arc;
    default: return Use::arrow;
  }
}

}  // namespace

Under Editor::under(const Pixel& pixel) const {
  const std::optional<render::Handle> shown = shown_handle();
  return shown && !pull_ && !axis_pick_.active() && !by_hand_.operation ? tools::part_of_handle(aim(), *shown, pixel) : Under::picture;
}

std::optional<render::Handle> Editor::shown_handle() const {
  render::Handle handle;
  if (pull_) {
    handle.at = pull_->foot(pulled_);
    handle.direction = pull_->direction();
    handle.use = use_of(pull_->handle());
    if (pull_->axis()) handle.turn = render::Handle::Turn{pull_->axis()->point, pull_->axis()->direction, pulled_.degrees};
    return handle;
  }
  if (!anchor_ || comparing_.shows_older() || !link_.connected() || link_.drag() != nullptr || by_hand_.operation) return std::nullopt;
  handle.at = anchor_->at;
  handle.direction = tools::arrow_direction(aim(), *anchor_);
  if (axis_) {
    handle.turn = render::Handle::Turn{axis_->point, axis_->direction, 0};
    handle.at = tools::ball_place(aim(), *axis_, anchor_->at);
  }
  return handle;
}

// --- pulling ---

void Editor::handle(const tools::HandleTaken& taken) { begin_pull(taken.handle, taken.at); }

void Editor::begin_pull(Under handle, const Pixel& at) {
  if (!anchor_ || link_.drag() != nullptr || leave_older_state()) return;
  leave_operation();
  comparing_.show_current();
  const stereo::Aim now = aim();
  const bool turning = handle == Under::turn_handle;
  if (turning && !axis_) return;
  const mesh::Vec3 foot = turning ? tools::ball_place(now, *axis_, anchor_->at) : anchor_->at;
  pull_.emplace(handle, foot, tools::arrow_direction(now, *anchor_), turning ? axis_ : std::nullopt, now, at);
  tool_ = handle;
  pulled_ = {};
  pulled_to_ = at;
  axis_taken_ = released_early_ = false;
  typed_pull_.reset();
  link_.begin_drag(tools::edit_of(handle, shaping_, anchor_->id, selection_centre_.value_or(anchor_->at), axis_, {}));
  if (link_.drag() == nullptr) pull_.reset();
}

void Editor::handle(const tools::HandleMoved& moved) {
  if (pull_ && !typed_pull_ && dialog_ != panels::Dialog::number) pull_to(moved.at);
}

void Editor::handle(const tools::HandleReleased& released) {
  // While a number is typed the pull waits for it.
  if (!pull_ || typed_pull_ || dialog_ == panels::Dialog::number) return;
  pull_to(released.at);
  if (axis_taken_)
    link_.commit_drag();
  else
    released_early_ = true;
}

void Editor::pull_to(const Pixel& pixel) {
  pulled_to_ = pixel;
  pulled_ = pull_->at(aim(), pixel, pulled_);
  if (axis_taken_) link_.pull(pulled_);
}

/// What was typed is what the edit says, to the last bit.
void Editor::send_pull() {
  if (!pull_ || !typed_pull_ || !axis_taken_) return;
  pulled_ = *typed_pull_;
  if (pull_->handle() == Under::lift_handle) pulled_.distance = pull_->lift_of(typed_pull_->distance);
  link_.pull(pulled_);
  link_.commit_drag();
}

void Editor::cancel_pull() {
  if (!pull_) return;
  pull_.reset();
  typed_pull_.reset();
  if (dialog_ == panels::Dialog::number && typing_.what == Typing::For::pull) dialog_ = panels::Dialog::none;
  link_.cancel_drag();
  ++changes_;
}

Result<void> Editor::follow_drag() {
  const RemoteDrag* drag = link_.drag();
  if (drag == nullptr) {
    if (preview_shown_) renderer_.end_preview();
    preview_shown_ = false;
    preview_sequence_ = 0;
    axis_taken_ = false;
    pull_.reset();
    typed_pull_.reset();
    return {};
  }
  if (!drag->begun()) return {};
  if (pull_ && !axis_taken_) {
    const ipc::DragBegun& facts = drag->facts();
    pull_->set_axis(aim(), mesh::Vec3(facts.grab_position[0], facts.grab_position[1], facts.grab_position[2]),
                    mesh::Vec3(facts.normal[0], facts.normal[1], facts.normal[2]));
    axis_taken_ = true;
    if (typed_pull_)
      send_pull();
    else
      pull_to(pulled_to_);
    if (released_early_) link_.commit_drag();
  }
  if (drag->frame().sequence == preview_sequence_) return {};
  if (!preview_shown_) renderer_.begin_preview(drag->preview().nodes(), drag->preview().shells());
  preview_shown_ = true;
  preview_sequence_ = drag->frame().sequence;
  if (Result<void> updated = renderer_.update_preview(drag->frame()); !updated) return updated;
  trace_.line(fmt::format("drag shown {} warn {} fail {}", preview_sequence_, drag->frame().counts.warn, drag->frame().counts.fail));
  return {};
}

// --- axes ---

void Editor::set_axis(const std::optional<tools::Axis>& axis, const std::string& what) {
  if (pull_) return;
  axis_pick_.cancel();
  axis_ = axis;
  tool_ = axis ? Under::turn_handle : Under::lift_handle;
  std::string text = "axis " + what;
  if (axis)
    for (const mesh::Vec3& each : {axis->point, axis->direction}) text += fmt::format(" {} {} {}", each.x(), each.y(), each.z());
  trace_.line(text);
}

void Editor::pick_axis() {
  if (pull_ || !shown_) return;
  axis_pick_.begin();
  trace_.line("axis picking");
}

void Editor::axis_clicked(const Pixel& at) {
  const std::optional<mesh::NodeIndex> node = node_at(at);
  if (!node || node->value >= shown_->node_count()) return;
  if (const std::optional<tools::Axis> axis = axis_pick_.clicked(shown_->position(node->value)))
    set_axis(axis, "through two nodes");
  else
    trace_.line("axis first node");
}

void Editor::axis_from_edge(const std::optional<Pixel>& pointer) {
  const auto shell = pointer && shown_ && pickable(*pointer) ? renderer_.shell_at(aim(), *pointer) : std::nullopt;
  const auto edge = shell ? tools::edge_at(*renderer_.model(), aim(), *shell, *pointer, region_angle_) : std::nullopt;
  if (edge) return set_axis(edge->axis, edge->what);
  notices_.say(Notice::Kind::information, "Point at a shell: the axis is the edge nearest to the pointer.");
}

void Editor::axis_from_deck(tools::DeckAxis axis) {
  if (anchor_) set_axis(tools::Axis{anchor_->at, tools::unit(axis)}, std::string(tools::kDeckAxisNames[static_cast<std::size_t>(axis)]));
}

// --- numbers ---

bool Editor::takes_numbers(const std::optional<Pixel>& pointer) const {
  if (dialog_open()) return false;
  if (pull_) return true;
  // A click leaves the pointer on the ring: there the view's keys stay what they are.
  const Under part = pointer ? under(*pointer) : Under::picture;
  return part != Under::picture && part != Under::move_handle;
}

void Editor::begin_number(const std::string& text, const std::optional<Pixel>& pointer) {
  if (!anchor_ && !pull_) return;
  if (pull_)
    tool_ = pull_->handle();
  else if (const Under part = pointer ? under(*pointer) : Under::picture; part != Under::picture)
    tool_ = part;
  else if ((tool_ == Under::turn_handle) != axis_.has_value())
    tool_ = axis_ ? Under::turn_handle : Under::lift_handle;
  typing_ = {Typing::For::pull, text, {}};
  open_dialog(panels::Dialog::number);
}

void Editor::enter_number(const std::string& text) {
  ++changes_;
  if (typing_.what != Typing::For::pull) {
    const Result<std::vector<double>> numbers = tools::parse_numbers(text);
    const bool limit = typing_.what == Typing::For::move_limit, off = text.find_first_not_of(' ') == std::string::npos;
    if (!off && (!numbers || numbers->size() != 1 || (limit && !(numbers->front() > 0)))) {
      typing_.problem = !numbers ? numbers.error().message
                        : limit  ? "type one number greater than 0, or nothing"
                                 : "type one number, or nothing";
      return;
    }
    (limit ? shaping_.max_move : shaping_.symmetry_place) = off ? std::nullopt : std::optional(numbers->front());
    dialog_ = panels::Dialog::none;
    return;
  }
  const Result<tools::Pull> typed = tools::typed_displacement(tool_, text, pulled_);
  if (!typed) {
    typing_.problem = typed.error().message;
    return;
  }
  dialog_ = panels::Dialog::none;
  trace_.line(fmt::format("typed {} {}", tools::name_of(tool_), text));
  if (!pull_) begin_pull(tool_, Pixel::Zero());
  if (!pull_) return;
  typed_pull_ = *typed;
  send_pull();
}

// --- how pulls fade out ---

bool Editor::change_shaping(Command command) {
  using mesh::shape::Origin;
  using mesh::shape::Profile;
  switch (command) {
    case Command::falloff:
      shaping_.profile = static_cast<Profile>((static_cast<int>(shaping_.profile) + 1) % (static_cast<int>(Profile::gaussian) + 1));
      break;
    case Command::flatter: shaping_.flat = std::min(1.0, std::round((shaping_.flat + tools::kFlatStep) * 100) / 100); break;
    case Command::less_flat: shaping_.flat = std::max(0.0, std::round((shaping_.flat - tools::kFlatStep) * 100) / 100); break;
    case Command::along: shaping_.along = tools::next(shaping_.along); break;
    case Command::free_ends: shaping_.free_ends = !shaping_.free_ends; break;
    case Command::origin: shaping_.origin = shaping_.origin == Origin::grab ? Origin::free_edge : Origin::grab; break;
    case Command::each_normal: shaping_.each_normal = !shaping_.each_normal; break;
    case Command::symmetry: shaping_.symmetry = tools::next(shaping_.symmetry); break;
    case Command::weights_across_welds: shaping_.across_welds = !shaping_.across_welds; break;
    case Command::move_limit:
    case Command::symmetry_place: {
      const bool limit = command == Command::move_limit;
      const std::optional<double>& now = limit ? shaping_.max_move : shaping_.symmetry_place;
      typing_ = {limit ? Typing::For::move_limit : Typing::For::symmetry_place, now ? fmt::format("{}", *now) : std::string(), {}};
      open_dialog(panels::Dialog::number);
      break;
    }
    default: return false;
  }
  return true;
}

}  // namespace prismesh::kiosk

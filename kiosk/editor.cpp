#include "kiosk/editor.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "kiosk/editor_keys.h"
#include "kiosk/input/key_table.h"
#include "kiosk/tool_list.h"
#include "kiosk/toolkit/edits.h"
#include "kiosk/toolkit/open_panels.h"
#include "kiosk/toolkit/picking.h"
#include "kiosk/tools/find/find_tool.h"

namespace prismesh::kiosk {

using input::Pixel;
using notices::Notice;
using toolkit::AsksQuestions;
using toolkit::Cover;
using toolkit::Pointer;
using toolkit::TakesNumbers;
using toolkit::Tool;

Editor::Editor(const stereo::Profile& profile, const toolkit::ToolOptions& options, const EditorServices& services)
    : notices_(services.trace), context_{services.link, services.pen, services.renderer, services.clock,     services.trace,
                                         notices_,      tools_,       options,           services.space_mice} {
  context_.view.profile = profile;
  context_.view.view.rotation = *stereo::named_rotation("iso");
  context_.commands = key_bindings();
  for (std::unique_ptr<Tool>& tool : make_tools(context_)) tools_.add(std::move(tool));
}

void Editor::set_picture_size(display::PixelSize size) {
  if (size == context_.view.size) return;
  context_.view.size = size;
  ++context_.changes;
}

void Editor::set_room(const render::PixelRect& room) {
  toolkit::PictureView& view = context_.view;
  view.room = room;
  const Eigen::Vector2d middle = toolkit::room_middle_mm(view);
  if ((middle - view.view.middle_mm).norm() < 1e-9) return;
  view.view.middle_mm = middle;
  ++context_.changes;
}

void Editor::point_at(const Pointer& pointer) {
  toolkit::PointedAt found = toolkit::pointed_at(context_, pointer);
  const bool same = found.words == context_.pointed.words;
  // Where nothing is pointed at, on panels too, the line of the last edit stays.
  if (result_left_ && !found.words.empty() && !context_.link.notices.result().empty()) {
    context_.link.notices.forget_result();
    ++context_.changes;
  }
  context_.pointed = std::move(found);
  if (!same) ++context_.changes;
}

void Editor::hover(const Pointer& pointer, bool follows) {
  const bool takes = pointer && !follows && !tools_.dragging() && !dialog_open() && context_.shown.snapshot;
  const toolkit::HandPlace now{pointer, takes ? tools_.under(*pointer) : input::Under::picture};
  const toolkit::HandPlace before = std::exchange(context_.hand, now);
  if (now != before && (now.on != input::Under::picture || before.on != input::Under::picture)) ++context_.changes;
}

void Editor::pointer_moved(const Pixel& at) {
  constexpr double kLeavesPixels = 40;  ///< farther from where it was the pointer looks at something else than the edit
  pointer_ = at;
  if ((at - result_at_).norm() > kLeavesPixels) result_left_ = true;
}

void Editor::look_from(const stereo::SeenFrom& seen) {
  context_.view.seen = seen;
  const std::int64_t now = context_.clock.now_ns();
  for (toolkit::MovesView* tool : tools_.with<toolkit::MovesView>()) tool->look(now);
}

void Editor::set_eyes_facts(std::optional<toolkit::EyesFacts> facts) {
  if (facts == context_.view.eyes) return;
  context_.view.eyes = std::move(facts);
  ++context_.changes;
}

void Editor::set_panel(const render::PanelPlace& panel) {
  if (panel == context_.view.panel) return;
  context_.view.panel = panel;
  ++context_.changes;
}

// --- following the model server ---

Result<void> Editor::follow() {
  link::ModelLink& link = context_.link;
  tools_.watch(context_.clock.now_ns());
  if (!std::exchange(context_.follow_soon, false) && link.changes() == link_changes_) return {};
  link_changes_ = link.changes();
  ++context_.changes;
  if (std::exchange(result_seen_, link.notices.results()) != link.notices.results()) {
    result_at_ = pointer_;
    result_left_ = false;
  }
  notices_.follow(link.document.number());
  for (Notice& notice : link.notices.take()) notices_.take(std::move(notice));
  for (const auto& tool : tools_.all())
    if (Result<void> prepared = tool->prepare(); !prepared) return prepared;
  take_newest();
  for (auto tool = tools_.all().rbegin(); tool != tools_.all().rend(); ++tool)
    if (Result<void> followed = (*tool)->follow(); !followed) return followed;
  return {};
}

Result<void> Editor::make_levels() {
  render::Renderer& renderer = context_.renderer;
  auto made = levels_.turn(context_.clock.now_ns(), renderer.shared_model(), !renderer.levels_are_current());
  if (!made) return {};
  context_.trace.line("levels " + std::to_string(made->levels.clusters.size()) + " clusters");
  return renderer.set_levels(std::move(*made));
}

bool Editor::prepare_picking(std::int64_t budget_ns) {
  return context_.renderer.draw_items_piece(toolkit::aim(context_.view), context_.clock, budget_ns);
}

/// The newest state becomes the one that is shown.
void Editor::take_newest() {
  toolkit::ShownModel& shown = context_.shown;
  const auto& next = context_.link.document.snapshot();
  if (next == shown.snapshot) return;
  const bool other_document = next && (!shown.snapshot || shown.document_number != context_.link.document.number());
  shown.document_number = context_.link.document.number();
  shown.snapshot = next;
  if (next) context_.link.notices.follow_state(next->info().generation, next->info().can_redo);
  // What stays within comfortable depth is what is shown now.
  if (const stereo::Box box = context_.renderer.bounds(); !box.empty()) context_.view.view.bounds = stereo::sphere_around(box);
  if (other_document) {
    context_.selection.last_clicked.reset();
    context_.selection.last_region.reset();
    context_.pointed = {};  // it speaks of the old deck until the pointer moves
  }
  toolkit::take_model(context_);
  if (const render::ModelSource* model = context_.renderer.model(); model != nullptr && toolkit::is_out_of_sight(context_.pointed, *model))
    context_.pointed = {};
  if (!other_document) return;
  for (const auto& tool : tools_.all()) tool->document_changed();
}

// --- gestures and keys ---

void Editor::gesture(const input::Gesture& gesture) {
  ++context_.changes;
  const std::optional<Pixel> picks = input::picks_at(gesture);
  if (picks && toolkit::is_beside(context_.view, *picks)) return cancel_gesture();
  if (const auto* click = std::get_if<input::NodeClicked>(&gesture); click != nullptr && click->takes_away && !tools_.in_mode()) {
    const auto node = toolkit::shown_node_at(context_, click->at);
    if (!node || !context_.shown.snapshot->selected(node->value)) return open_menu(click->at);
  }
  if (input::asks_for_edit(gesture) && !tools_.allow_edit()) return;
  tools_.gesture(gesture);
}

void Editor::cancel_gesture() {
  tools_.cancel_gesture();
  ++context_.changes;
}

void Editor::command(const input::Command& command, const Pointer& pointer) {
  ++context_.changes;
  if (!tools_.allow_command(command)) return;
  if (input::binding_of(key_bindings(), command).asks_for_edit() && !tools_.allow_edit()) return;
  if (command == command_of(EditorCommand::menu_at_pointer))
    open_menu(pointer);
  else if (command.owner == kEditorName)
    own_command(command.number);
  else
    tools_.command(command, pointer);
}

void Editor::own_command(std::uint8_t number) {
  switch (static_cast<EditorCommand>(number)) {
    case EditorCommand::undo: toolkit::send(context_, mesh::document::Undo{}); break;
    case EditorCommand::redo: toolkit::send(context_, mesh::document::Redo{}); break;
    case EditorCommand::cancel: cancel(false); break;
    case EditorCommand::stop_and_keep: cancel(true); break;
    case EditorCommand::menu: toggle_cover(Cover::menu); break;
    case EditorCommand::menu_at_pointer: break;  // needs the pointer, see command()
    case EditorCommand::help: toggle_cover(Cover::help); break;
    case EditorCommand::deck_warnings:
      if (context_.shown.snapshot) toggle_cover(Cover::warnings);
      break;
    case EditorCommand::set_up: set_up(); break;
    case EditorCommand::fullscreen:
    case EditorCommand::rearm: break;
  }
}

/// In the same window, which then comes back here.
void Editor::set_up() {
  std::error_code none;
  if (context_.options.setup.empty() || !std::filesystem::exists(context_.options.setup, none))
    return notices_.say(Notice::Kind::information,
                        "This machine isn't set up from the kiosk: that is the appliance's (docs/appliance.md).");
  context_.quits = context_.anew = context_.sets_up = true;
}

void Editor::open_menu(const Pointer& pointer) {
  if (!pointer || !context_.shown.snapshot || dialog_open()) return;
  point_at(pointer);
  context_.open.menu_at = *pointer;
}

void Editor::toggle_cover(Cover cover) { toolkit::set_cover(context_, context_.open.cover == cover ? Cover::none : cover); }

/// What lies on top goes first. `keep`: what a repair has reached.
void Editor::cancel(bool keep) {
  if (context_.link.connection.progress().can_stop()) return context_.link.connection.stop(keep);
  if (tools_.dragging()) return cancel_gesture();
  if (AsksQuestions* asking = tools_.asking(); asking != nullptr)
    asking->reply(panels::Reply::cancel);
  else if (context_.open.dialog.owner != nullptr)
    toolkit::close_dialog(context_);
  else if (context_.open.cover != Cover::none)
    toolkit::set_cover(context_, Cover::none);
  else if (tools_.leave_mode())
    return;
  else if (!notices_.empty())
    notices_.read();
  else if (!tools_.take_back())
    tools_.clear();
}

void Editor::panel_action(const std::function<void()>& action) {
  ++context_.changes;
  action();
}

void Editor::panel_command(const input::Command& command, const Pointer& pointer) {
  if (context_.open.cover == Cover::menu) toolkit::set_cover(context_, Cover::none);
  this->command(command, pointer);
}

void Editor::find(const std::string& begun) {
  context_.open.begun = begun;
  command(tools::find::find_command(), std::nullopt);
}

bool Editor::reply_by_key(display::Key key) {
  AsksQuestions* asking = tools_.asking();
  if (asking == nullptr) return false;
  const auto& choices = asking->question()->choices;
  const auto chosen = std::find_if(choices.begin(), choices.end(), [&](const panels::Question::Choice& each) { return each.key == key; });
  if (chosen == choices.end() || chosen->reply == panels::Reply::cancel) return false;
  asking->reply(chosen->reply);
  ++context_.changes;
  return true;
}

bool Editor::takes_numbers(const Pointer& pointer) const {
  if (dialog_open()) return false;
  return std::ranges::any_of(tools_.with<TakesNumbers>(), [&](const TakesNumbers* tool) { return tool->takes_numbers(pointer); });
}

void Editor::begin_number(const std::string& text, const Pointer& pointer) {
  for (TakesNumbers* tool : tools_.with<TakesNumbers>())
    if (tool->takes_numbers(pointer) && tool->begin_number(text, pointer)) return;
}

// --- the picture ---

render::Picture Editor::picture() const {
  render::Picture picture = toolkit::plain_picture(context_.view);
  for (const auto& tool : tools_.all()) tool->add_to_picture(picture);
  return picture;
}

void Editor::set_report(const render::DrawReport& report) {
  context_.glyphs_left_out = report.glyphs_left_out;
  context_.video_memory = report.memory;
  if (report.memory.limit > 0) tell_video_memory();
}

/// Says what is given up when it is more than was said of this document, not when it is less.
void Editor::tell_video_memory() {
  const render::VideoMemory& memory = context_.video_memory;
  if (std::exchange(told_document_, context_.link.document.number()) != context_.link.document.number()) {
    told_given_up_ = {};
    told_exceeded_ = false;
  }
  const render::GivenUp all = told_given_up_.with(memory.given_up);
  if (all == told_given_up_ && (told_exceeded_ || !memory.is_exceeded())) return;
  told_given_up_ = all;
  told_exceeded_ = told_exceeded_ || memory.is_exceeded();
  notices_.say(Notice::Kind::warning, render::sentence_of(memory));
  ++context_.changes;
}

void Editor::trace_picture() {
  if (!context_.trace.on()) return;
  const stereo::Aim now = toolkit::aim(context_.view);
  const Eigen::Matrix4d clip = now.clip_from_deck();
  std::string text = fmt::format("aim {} {}", now.width, now.height);
  for (int i = 0; i < 16; ++i) text += fmt::format(" {}", clip.data()[i]);
  if (text != traced_aim_) context_.trace.line(traced_aim_ = text);
  for (toolkit::TracesPicture* tool : tools_.with<toolkit::TracesPicture>()) tool->trace_picture();
  const render::VideoMemory& memory = context_.video_memory;
  text = "video memory " + render::megabytes_of(memory) + (memory.given_up.any() ? ": " + render::in_words(memory.given_up) : "");
  if (text != traced_memory_) context_.trace.line(traced_memory_ = text);
  text = notices_.empty() ? "notice none" : notices::trace_of(notices_.front());
  text.replace(0, std::string_view("notice").size(), "reads");
  if (text != traced_notice_) context_.trace.line(traced_notice_ = text);
}

}  // namespace prismesh::kiosk

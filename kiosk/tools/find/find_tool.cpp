#include "kiosk/tools/find/find_tool.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "base/readable_number.h"
#include "kiosk/panels/text.h"
#include "kiosk/toolkit/model_boxes.h"
#include "kiosk/toolkit/open_panels.h"
#include "kiosk/toolkit/picking.h"
#include "kiosk/toolkit/tool_set.h"
#include "kiosk/tools/find/find_commands.h"

namespace prismesh::kiosk::tools::find {
namespace {

constexpr std::string_view kName = "find";
constexpr std::size_t kMaxCommands = 200, kMaxParts = 6;

enum class FindCommand : std::uint8_t { find };

constexpr input::Command command_of(FindCommand command) { return {kName, static_cast<std::uint8_t>(command)}; }

constexpr std::array kKeys = {
    input::KeyBinding{display::letter('P'), true, false, command_of(FindCommand::find), input::Menu::edit, "Ctrl+P",
                      "find a command, or go to a node, shell or part by its id"},
};

std::string at_words(const mesh::Vec3& at, const std::string& unit) {
  return fmt::format("({} {} {}) {}", readable(at.x(), 6), readable(at.y(), 6), readable(at.z(), 6), unit);
}

std::string part_words(const ipc::SnapshotPart& part) {
  return fmt::format("part {}", part.id) + (part.name.empty() ? "" : "  " + panels::printable(part.name));
}

}  // namespace

std::span<const input::KeyBinding> keys() { return kKeys; }

input::Command find_command() { return command_of(FindCommand::find); }

std::string_view FindTool::name() const { return kName; }

void FindTool::command(std::uint8_t, const toolkit::Pointer&) {
  entry_ = {};
  entry_.typed = std::exchange(context_.open.begun, {});
  found_.reset();
  toolkit::open_dialog(context_, this);
}

/// What was gone to may be elsewhere in the arrays, or gone.
void FindTool::model_changed() {
  found_.reset();
  if (!gone_to_ || gone_to_->kind == TypedId::Kind::part) return;
  const auto node = gone_to_->kind == TypedId::Kind::node ? toolkit::node_with_id(context_, gone_to_->id) : std::nullopt;
  const auto shell = gone_to_->kind == TypedId::Kind::shell ? toolkit::shell_with_id(context_, gone_to_->id) : std::nullopt;
  if (node)
    gone_to_->index = node->value;
  else if (shell)
    gone_to_->index = shell->value;
  else
    gone_to_.reset();
}

// --- finding ---

void FindTool::find() {
  const std::uint64_t generation = context_.shown.snapshot ? context_.shown.snapshot->info().generation : 0;
  if (found_ && found_->text == entry_.typed && found_->generation == generation) return;
  found_ = Found{entry_.typed, generation, {}, {}};
  if (context_.shown.snapshot) find_places(entry_.typed);
  for (const std::size_t i : find_commands(entry_.typed, context_.commands, used_.entries(), kMaxCommands)) {
    const input::KeyBinding& binding = context_.commands[i];
    if (binding.command == find_command()) continue;
    const std::string_view menu = input::kMenuNames[static_cast<std::size_t>(binding.menu)];
    found_->hits.push_back({&binding, {fmt::format("{}: {}", menu, binding.meaning), std::string(binding.label)}});
  }
  if (!found_->hits.empty()) return;
  if (!found_->problem.empty()) return;
  found_->problem = !context_.shown.snapshot ? "No command has all of these words. Ids can be gone to when a deck is open."
                    : typed_id(entry_.typed) ? "There is no node, shell or part of that id."
                                             : "No command and no part has all of these words.";
}

void FindTool::find_places(std::string_view text) {
  using Kind = TypedId::Kind;
  const auto& shown = context_.shown.snapshot;
  const ipc::SnapshotInfo& info = shown->info();
  if (const std::optional<TypedId> typed = typed_id(text)) {
    const auto wanted = [&](Kind kind) { return typed->kind == Kind::any || typed->kind == kind; };
    const auto node = wanted(Kind::node) ? toolkit::node_with_id(context_, typed->id) : std::nullopt;
    if (node && !toolkit::is_used(context_, *node))
      found_->problem = fmt::format("Node {} belongs to no element: it was removed, or never had one.", typed->id);
    else if (node)
      add_place({Kind::node, typed->id, node->value},
                fmt::format("node {}  {}", typed->id, at_words(shown->position(node->value), info.length_unit)));
    if (const auto shell = wanted(Kind::shell) ? toolkit::shell_with_id(context_, typed->id) : std::nullopt) {
      const mesh::PartIndex part = shown->shell_part(shell->value);
      add_place({Kind::shell, typed->id, shell->value},
                fmt::format("shell {}", typed->id) + (part.value < info.parts.size() ? "  " + part_words(info.parts[part.value]) : ""));
    }
    for (std::size_t i = 0; wanted(Kind::part) && i < info.parts.size(); ++i)
      if (info.parts[i].id == typed->id) add_place({Kind::part, typed->id, i}, part_words(info.parts[i]));
    return;
  }
  if (text.find_first_not_of(' ') == std::string_view::npos) return;
  std::size_t count = 0;
  for (std::size_t i = 0; i < info.parts.size() && count < kMaxParts; ++i) {
    if (info.parts[i].shells == 0 || fit_of(text, info.parts[i].name) == 0) continue;
    add_place({Kind::part, info.parts[i].id, i}, part_words(info.parts[i]));
    ++count;
  }
}

void FindTool::add_place(const Place& place, const std::string& words) { found_->hits.push_back({place, {words, "go there"}}); }

// --- taking ---

void FindTool::take(const Hit& hit) {
  if (const auto* place = std::get_if<Place>(&hit.what)) return go_to(*place);
  used_.add(std::string(std::get<const input::KeyBinding*>(hit.what)->meaning));
}

void FindTool::go_to(const Place& place) {
  const auto& shown = context_.shown.snapshot;
  if (!shown) return;
  gone_to_ = place;
  toolkit::PictureView& view = context_.view;
  context_.trace.line("gone to " + words_of(place));
  if (place.kind == TypedId::Kind::part) {
    const stereo::Box box = toolkit::turned_box_of_part(context_, mesh::PartIndex(place.index));
    if (box.empty()) return;
    view.view = stereo::fit_turned(view.view, box, toolkit::room_of_view_mm(view), view.seen.between_eyes_mm.z());
    return context_.tools.view_moved();
  }
  mesh::Vec3 at = mesh::Vec3::Zero();
  if (place.kind == TypedId::Kind::node) {
    at = shown->position(place.index);
  } else {
    int corners = 0;
    for (const mesh::NodeIndex node : shown->shell(place.index).node) {
      if (!node.valid() || node.value >= shown->node_count()) continue;
      at += shown->position(node.value);
      ++corners;
    }
    at /= std::max(corners, 1);
  }
  const double scale = toolkit::scale_to_look_at(shown->info().target_size, view.view.mm_per_unit, toolkit::aim(view).mm_per_pixel());
  view.glide.begin(at, scale, context_.clock.now_ns());
}

bool FindTool::take_back() {
  const bool was = std::exchange(gone_to_, std::nullopt).has_value();
  if (was) ++context_.changes;
  return was;
}

// --- picture and panels ---

std::string FindTool::words_of(const Place& place) const {
  const auto& shown = context_.shown.snapshot;
  const ipc::SnapshotInfo& info = shown->info();
  switch (place.kind) {
    case TypedId::Kind::node: return fmt::format("node {}  {}", place.id, at_words(shown->position(place.index), info.length_unit));
    case TypedId::Kind::shell: return fmt::format("shell {}", place.id);
    default: return place.index < info.parts.size() ? part_words(info.parts[place.index]) : fmt::format("part {}", place.id);
  }
}

void FindTool::add_to_picture(render::Picture& picture) const {
  const auto& shown = context_.shown.snapshot;
  if (!gone_to_ || !shown || context_.shown.older) return;
  if (gone_to_->kind == TypedId::Kind::node && gone_to_->index < shown->node_count())
    picture.marked_point = shown->position(gone_to_->index);
  if (gone_to_->kind == TypedId::Kind::shell && gone_to_->index < shown->shell_count()) picture.marked = mesh::ShellIndex(gone_to_->index);
}

std::string FindTool::guidance() const {
  if (!gone_to_ || !context_.shown.snapshot) return {};
  return words_of(*gone_to_) + "   Esc takes the mark away";
}

void FindTool::draw_dialog(int, bool opened, panels::PanelLayout& layout) {
  find();
  FindFacts facts;
  for (const Hit& hit : found_->hits) facts.rows.push_back(hit.row);
  facts.problem = found_->problem;
  const std::optional<std::size_t> taken = find_box(facts, opened, entry_, layout);
  if (!taken || *taken >= found_->hits.size()) return;
  const Hit hit = found_->hits[*taken];
  layout.ask([this] { toolkit::close_dialog(context_); });
  layout.ask([this, hit] { take(hit); });
  if (const auto* command = std::get_if<const input::KeyBinding*>(&hit.what)) layout.ask((*command)->command);
}

}  // namespace prismesh::kiosk::tools::find

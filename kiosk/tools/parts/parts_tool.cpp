#include "kiosk/tools/parts/parts_tool.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "kiosk/render/palette.h"
#include "kiosk/toolkit/edits.h"
#include "kiosk/toolkit/picking.h"
#include "kiosk/tools/parts/file_expression.h"
#include "kiosk/tools/parts/parts_keys.h"
#include "mesh/select/expression.h"

namespace prismesh::kiosk::tools::parts {
namespace {

using toolkit::Pointer;

using mesh::document::VisibilityAction;

unsigned packed(const render::Colour& colour) {
  const auto byte = [](float value) { return static_cast<unsigned>(std::lround(std::clamp(value, 0.0F, 1.0F) * 255)); };
  return 0xff000000U | byte(colour.z()) << 16 | byte(colour.y()) << 8 | byte(colour.x());
}

/// Whether there are ids, and all are in a list; both ascend.
bool all_in(const std::vector<std::int64_t>& ids, const std::vector<std::int64_t>& list) {
  return !ids.empty() && std::includes(list.begin(), list.end(), ids.begin(), ids.end());
}

}  // namespace

std::span<const input::KeyBinding> keys() { return kKeys; }

std::string_view PartsTool::name() const { return kName; }

void PartsTool::command(std::uint8_t number, const Pointer& pointer) {
  switch (static_cast<PartsCommand>(number)) {
    case PartsCommand::hide: set_part(VisibilityAction::hide, pointer); break;
    case PartsCommand::only: set_part(VisibilityAction::only, pointer); break;
    case PartsCommand::show_all: show_all(); break;
    case PartsCommand::reverse: set_part(VisibilityAction::reverse, std::nullopt); break;
    case PartsCommand::lock: set_part(VisibilityAction::lock, pointer); break;
    case PartsCommand::unlock: set_part(VisibilityAction::unlock, pointer); break;
    case PartsCommand::hide_file: set_file(VisibilityAction::hide, pointer); break;
    case PartsCommand::only_file: set_file(VisibilityAction::only, pointer); break;
    case PartsCommand::lock_file: set_file(VisibilityAction::lock, pointer); break;
  }
}

void PartsTool::set(const std::optional<std::string>& on, VisibilityAction action) {
  mesh::document::SetParts edit;
  edit.action = action;
  edit.on = on;
  toolkit::send(context_, std::move(edit));
}

std::optional<mesh::PartIndex> PartsTool::part_at(const Pointer& pointer) const {
  const auto shell = toolkit::shell_at(context_, pointer);
  const auto& shown = context_.shown.snapshot;
  if (!shell || shell->value >= shown->shell_count()) return std::nullopt;
  const mesh::PartIndex part = shown->shell_part(shell->value);
  return part.value < shown->info().parts.size() ? std::optional(part) : std::nullopt;
}

/// The part under the pointer, or else those of the selection.
void PartsTool::set_part(VisibilityAction action, const Pointer& pointer) {
  if (!context_.shown.snapshot) return;
  const auto part = part_at(pointer);
  set(part ? std::optional(std::to_string(context_.shown.snapshot->info().parts[part->value].id)) : std::nullopt, action);
}

/// The file of the part under the pointer; of several files that hold the part the first. Locking unlocks what is locked.
void PartsTool::set_file(VisibilityAction action, const Pointer& pointer) {
  const auto index = part_at(pointer);
  if (!index || !context_.link.document.state()) return;
  const ipc::SnapshotPart& part = context_.shown.snapshot->info().parts[index->value];
  for (const ipc::DeckFile& file : context_.link.document.state()->files) {
    if (!std::binary_search(file.parts.begin(), file.parts.end(), part.id)) continue;
    const bool unlocks = action == VisibilityAction::lock && part.locked;
    return set(file_expression(file.name), unlocks ? VisibilityAction::unlock : action);
  }
}

void PartsTool::show_all() {
  if (!context_.shown.snapshot) return;
  std::vector<std::int64_t> hidden;
  for (const ipc::SnapshotPart& part : context_.shown.snapshot->info().parts)
    if (part.hidden) hidden.push_back(part.id);
  if (!hidden.empty()) set(mesh::select::to_expression(std::move(hidden)), VisibilityAction::show);
}

// --- the list ---

PartFacts PartsTool::facts() const {
  const ipc::SnapshotInfo& info = context_.shown.snapshot->info();
  PartFacts facts;
  facts.parts.reserve(info.parts.size());
  std::vector<std::int64_t> hidden, locked;
  for (std::size_t i = 0; i < info.parts.size(); ++i) {
    const ipc::SnapshotPart& part = info.parts[i];
    const render::Colour& colour = render::part_colours()[render::colour_of_part(i, info.parts.size())];
    facts.parts.push_back({part.id, part.name, part.shells, packed(colour), part.hidden, part.locked});
    if (part.hidden) hidden.push_back(part.id);
    if (part.locked) locked.push_back(part.id);
  }
  if (!context_.link.document.state() || context_.link.document.state()->files.size() < 2) return facts;  // one file is the deck itself
  std::sort(hidden.begin(), hidden.end());
  std::sort(locked.begin(), locked.end());
  for (const ipc::DeckFile& file : context_.link.document.state()->files)
    facts.files.push_back({file.name, file.shells, file.parts.size(), all_in(file.parts, hidden), all_in(file.parts, locked)});
  return facts;
}

void PartsTool::draw_tab(panels::PanelLayout& layout) {
  for (const SetVisibility& wanted : part_list(facts(), layout)) layout.ask([this, wanted] { set(wanted.on, wanted.action); });
}

}  // namespace prismesh::kiosk::tools::parts

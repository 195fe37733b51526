#include "kiosk/tools/parts/parts_tool.h"

#include <algorithm>
#include <unordered_map>
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

/// The facts cost the number of parts and of shells that changed: they are made once for a generation and after a change of colours.
void PartsTool::bring_facts() {
  const auto& shown = context_.shown.snapshot;
  const auto& state = context_.link.document.state();
  Facts from{shown, state ? state->files.size() : 0, paint_changes_};
  if (from == facts_from_) return;
  facts_from_ = std::move(from);
  tree_.set_facts(facts(errors_.count(*render::snapshot_source(shown))));
}

PartFacts PartsTool::facts(const std::vector<Errors>& errors) const {
  const ipc::SnapshotInfo& info = context_.shown.snapshot->info();
  PartFacts facts;
  facts.parts.reserve(info.parts.size());
  std::unordered_map<std::int64_t, Errors> errors_of;
  std::vector<std::int64_t> hidden, locked;
  for (std::size_t i = 0; i < info.parts.size(); ++i) {
    const ipc::SnapshotPart& part = info.parts[i];
    const render::PartPaint paint = paint_of(part.id);
    const render::Colour& own = render::part_colours()[render::colour_of_part(i, info.parts.size())];
    facts.parts.push_back(
        {part.id, part.name, part.shells, errors[i], packed(paint.colour.value_or(own)), part.hidden, part.locked, paint.transparent});
    errors_of.emplace(part.id, errors[i]);
    if (part.hidden) hidden.push_back(part.id);
    if (part.locked) locked.push_back(part.id);
  }
  if (!context_.link.document.state() || context_.link.document.state()->files.size() < 2) return facts;  // one file is the deck itself
  std::sort(hidden.begin(), hidden.end());
  std::sort(locked.begin(), locked.end());
  for (const ipc::DeckFile& file : context_.link.document.state()->files) {
    Errors sum;
    for (const std::int64_t id : file.parts)
      if (const auto its = errors_of.find(id); its != errors_of.end()) sum.warn += its->second.warn, sum.fail += its->second.fail;
    facts.files.push_back({file.name, file.shells, file.parts, sum, all_in(file.parts, hidden), all_in(file.parts, locked)});
  }
  return facts;
}

void PartsTool::draw_tab(panels::PanelLayout& layout) {
  bring_facts();
  PartWishes wishes = part_list(tree_, layout);
  for (const SetVisibility& wanted : wishes.edits) layout.ask([this, wanted] { set(wanted.on, wanted.action); });
  for (const SetPaint& wanted : wishes.paints) layout.ask([this, wanted] { paint(wanted); });
}

// --- colours of this kiosk ---

render::PartPaint PartsTool::paint_of(std::int64_t part) const {
  const auto found = paints_.find(part);
  return found == paints_.end() ? render::PartPaint{} : found->second;
}

void PartsTool::paint(const SetPaint& wanted) {
  for (const std::int64_t id : wanted.parts) {
    render::PartPaint& paint = paints_[id];
    if (wanted.transparent) paint.transparent = *wanted.transparent;
    if (wanted.colours) paint.colour = wanted.colour;
  }
  ++paint_changes_;
  show_paints();
}

void PartsTool::show_paints() {
  ++context_.changes;
  std::vector<render::PartPaint> paints;
  if (const auto& shown = context_.shown.snapshot; shown && !paints_.empty())
    for (const ipc::SnapshotPart& part : shown->info().parts) paints.push_back(paint_of(part.id));
  if (const Result<void> done = context_.renderer.set_part_paints(paints); !done)
    context_.notices.say(notices::Notice::Kind::error, done.error().text());
}

void PartsTool::document_changed() {
  tree_.forget();
  errors_ = {};
  facts_from_ = {};
  if (paints_.empty()) return;
  paints_.clear();
  ++paint_changes_;
  show_paints();
}

}  // namespace prismesh::kiosk::tools::parts

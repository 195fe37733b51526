#include <algorithm>

#include "base/counted.h"
#include "base/readable_number.h"
#include "mesh/document/apply.h"
#include "mesh/document/deck_relations.h"
#include "mesh/document/edit_kinds.h"
#include "mesh/document/judge_parts.h"
#include "mesh/document/judging_rules.h"
#include "mesh/document/part_marks.h"
#include "mesh/document/selection.h"
#include "mesh/model/adjacency.h"

namespace prismesh::mesh::document {

namespace {

using PartFlags = std::vector<std::uint8_t>;  ///< by PartIndex: 1 if the edit names the part

void flag_parts_of(const Model& model, const ShellSet& shells, PartFlags& flags) {
  for (const ShellIndex shell : shells)
    if (const PartIndex part = model.shell_parts[shell.value]; part.valid()) flags[part.value] = 1;
}

/// The parts of the selection: of the selected shells; for nodes, of the shells with all nodes selected, or, if there are none, of all
/// shells that touch it; and of other elements at nodes that no shell uses.
PartFlags parts_of_selection(const Document& document) {
  const Generation& current = document.current();
  const Model& model = current.model;
  PartFlags flags(model.parts->size(), 0);
  const Selection selected = selection_of(current);
  if (selected.kind != select::EntityKind::node) {
    flag_parts_of(model, selected.shells, flags);
    return flags;
  }
  const ShellSet inside = shells_inside(model, selected.nodes);
  flag_parts_of(model, inside.empty() ? shells_touching(model, selected.nodes) : inside, flags);
  for (const NodeIndex node : selected.nodes) {
    if (!model.adjacency->shells_of(node).empty()) continue;
    for (const ElementUse& use : uses_at(*current.relations, node)) {
      const PartIndex part = model.elements[static_cast<std::size_t>(use.element_class)]->part[use.element];
      if (part.valid()) flags[part.value] = 1;
    }
  }
  return flags;
}

Result<PartFlags> parts_named(const Document& document, const SetParts& edit) {
  const Model& model = document.current().model;
  if (edit.on) {
    const Result<select::Chosen> chosen = select::evaluate(model, *edit.on, select::EntityKind::part, document.current().relations->names);
    if (!chosen) return fail(chosen.error());
    PartFlags flags(model.parts->size(), 0);
    for (const PartIndex part : chosen->parts) flags[part.value] = 1;
    return flags;
  }
  if (edit.action == VisibilityAction::reverse) return PartFlags(model.parts->size(), 1);
  const bool reveals = edit.action == VisibilityAction::show || edit.action == VisibilityAction::unlock;
  if (document.current().selected_nodes == 0) {
    if (reveals) return PartFlags(model.parts->size(), 1);
    return fail("", std::string(name(Edit(edit))) + ": nothing is selected, and \"on\" names no part");
  }
  return parts_of_selection(document);
}

void set_state(PartState& state, VisibilityAction action, bool is_named) {
  switch (action) {
    case VisibilityAction::hide: state.hidden = state.hidden || is_named; break;
    case VisibilityAction::show: state.hidden = state.hidden && !is_named; break;
    case VisibilityAction::only: state.hidden = !is_named; break;
    case VisibilityAction::reverse: state.hidden = state.hidden != is_named; break;
    case VisibilityAction::lock: state.locked = state.locked || is_named; break;
    case VisibilityAction::unlock: state.locked = state.locked && !is_named; break;
  }
}

/// Deselects what is hidden: nobody should move what they can't see.
void deselect_hidden(const Document& document, Generation& next, EditReport& report) {
  const Selection before = selection_of(document.current());
  Selection after = before;
  std::erase_if(after.shells, [&](ShellIndex shell) {
    const PartIndex part = next.model.shell_parts[shell.value];
    return part.valid() && (*next.parts)[part.value].hidden;
  });
  if (before.kind == select::EntityKind::node)
    std::erase_if(after.nodes, [&](NodeIndex node) { return (next.node_marks[node.value] & kHidden) != 0; });
  else if (after.shells.size() != before.shells.size())
    after.nodes = nodes_of(next.model, after.shells);
  if (after.nodes.size() == before.nodes.size() && after.shells.size() == before.shells.size()) return;
  put_selection(next, before, after);
  report.notes.push_back(counted(before.nodes.size() - after.nodes.size(), "hidden node") + " deselected");
}

}  // namespace

Result<void> apply_edit(const Document& document, const SetParts& edit, Generation& next, EditReport& report) {
  const Result<PartFlags> named = parts_named(document, edit);
  if (!named) return fail(named.error());
  auto states = std::make_shared<std::vector<PartState>>(*next.parts);
  std::size_t changed = 0;
  for (std::size_t p = 0; p < states->size(); ++p) {
    set_state((*states)[p], edit.action, (*named)[p] != 0);
    if (!((*states)[p] == (*next.parts)[p])) ++changed;
  }
  if (changed == 0) {
    report.notes.push_back("no part changed");
    return {};
  }
  next.parts = std::move(states);
  mark_parts(next.model, *next.parts, next.node_marks);
  if (edit.action != VisibilityAction::show && edit.action != VisibilityAction::lock && edit.action != VisibilityAction::unlock)
    deselect_hidden(document, next, report);
  return {};
}

namespace {

/// All parts, if the edit names none and nothing is selected.
Result<PartFlags> parts_to_size(const Document& document, const SetTargetSize& edit) {
  const Generation& current = document.current();
  if (edit.on) {
    const Result<std::vector<PartIndex>> parts = parts_named_by(*edit.on, current.model, current.relations->names);
    if (!parts) return fail(parts.error());
    PartFlags flags(current.model.parts->size(), 0);
    for (const PartIndex part : *parts) flags[part.value] = 1;
    return flags;
  }
  if (current.selected_nodes == 0 && current.selected_shells == 0) return PartFlags(current.model.parts->size(), 1);
  return parts_of_selection(document);
}

/// The sizes of the parts whose size changed: "part 3 is judged by a target size of 5, before by 10".
void note_sizes(const Model& model, const Judging& before, const Judging& now, EditReport& report) {
  constexpr std::size_t kMaxNamedParts = 10;
  std::size_t changed = 0;
  for (std::size_t p = 0; p < now.parts.size(); ++p) {
    const double was = before.by_part.of(PartIndex(p)).target_size, is = now.by_part.of(PartIndex(p)).target_size;
    if (was == is || ++changed > kMaxNamedParts) continue;
    report.notes.push_back("part " + std::to_string((*model.parts)[p].id) + ": target size " + readable(is, 6) + ", before " +
                           readable(was, 6));
  }
  if (changed == 0) report.notes.push_back("no part's target size changed");
  if (changed > kMaxNamedParts) report.notes.push_back("and of " + counted(changed - kMaxNamedParts, "more part"));
}

}  // namespace

Result<void> apply_edit(const Document& document, const SetTargetSize& edit, Generation& next, EditReport& report) {
  if (const Result<void> sound = check_target_size(edit.size); !sound) return sound;
  const Result<PartFlags> named = parts_to_size(document, edit);
  if (!named) return fail(named.error());
  auto judging = std::make_shared<Judging>(*next.judging);
  if (std::all_of(named->begin(), named->end(), [](std::uint8_t flag) { return flag != 0; })) {
    judging->target_size = edit.size;
    for (PartChoice& choice : judging->parts) choice.target_size.reset();
  } else {
    for (std::size_t p = 0; p < named->size(); ++p)
      if ((*named)[p] != 0) judging->parts[p].target_size = edit.size;
  }
  settle(*judging);
  note_sizes(next.model, *next.judging, *judging, report);
  rejudge_parts(next.model, document.settings.criteria, *next.judging, *judging, next.quality, next.counts);
  next.judging = std::move(judging);
  return {};
}

}  // namespace prismesh::mesh::document

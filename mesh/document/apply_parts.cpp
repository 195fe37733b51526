#include <algorithm>

#include "base/counted.h"
#include "mesh/document/apply.h"
#include "mesh/document/deck_relations.h"
#include "mesh/document/edit_kinds.h"
#include "mesh/document/part_marks.h"
#include "mesh/document/parts_of_selection.h"
#include "mesh/document/selection.h"

namespace prismesh::mesh::document {

namespace {

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

}  // namespace prismesh::mesh::document

#include "mesh/document/restructure.h"

#include <algorithm>
#include <array>

#include "base/counted.h"
#include "mesh/deck/editing/new_ids.h"
#include "mesh/deck/editing/text_changes.h"
#include "mesh/document/apply.h"
#include "mesh/document/clusters.h"
#include "mesh/document/deck_relations.h"
#include "mesh/document/part_marks.h"
#include "mesh/document/selection.h"
#include "mesh/model/adjacency.h"
#include "mesh/model/topology_change.h"

namespace prismesh::mesh::document {

namespace {

/// The existing corners of the shells, before and after: their marks by part states may have changed.
NodeSet corners_of_changed(const Model& before, const Model& after, const Changes& changes) {
  NodeSet nodes;
  const auto add = [&](const Model& model, const ShellSet& shells) {
    for (const ShellIndex shell : shells)
      for (const NodeIndex node : model.shell(shell).node) nodes.push_back(node);
  };
  add(before, changes.removed_shells);
  add(before, changes.reshaped_shells);
  add(after, changes.reshaped_shells);
  add(after, changes.added_shells);
  nodes.insert(nodes.end(), changes.added_nodes.begin(), changes.added_nodes.end());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  std::erase_if(nodes, [&](NodeIndex node) { return after.is_removed(node); });
  return nodes;
}

/// A new node is selected if all it comes from are, a new shell if its parent is; a removed one isn't.
void carry_selection(const Changes& changes, Generation& next) {
  const auto node_selected = [&](NodeIndex node) { return (next.node_marks[node.value] & kSelected) != 0; };
  for (const NodeIndex node : changes.added_nodes) {
    if (placed_node(next.model, node) != nullptr) continue;
    const NodeOrigin& origin = origin_of(next.model, node);
    bool all = true;
    for (int p = 0; p < origin.count(); ++p) all = all && node_selected(origin.parent[static_cast<std::size_t>(p)]);
    if (!all) continue;
    next.node_marks.set(node.value, kSelected);
    ++next.selected_nodes;
  }
  for (const ShellIndex shell : changes.added_shells) {
    const ShellIndex parent = next.model.topology_change->shell_parents[shell.value - next.model.topology_change->deck_shells];
    if ((next.shell_marks[parent.value] & kSelected) == 0) continue;
    next.shell_marks.set(shell.value, kSelected);
    ++next.selected_shells;
  }
  for (const NodeIndex node : changes.removed_nodes) {
    if (node_selected(node)) --next.selected_nodes;
    if (next.node_marks[node.value] != 0) next.node_marks.set(node.value, 0);
  }
  for (const ShellIndex shell : changes.removed_shells) {
    if (next.shell_marks[shell.value] == 0) continue;
    --next.selected_shells;
    next.shell_marks.set(shell.value, 0);
  }
}

std::size_t& count_of(quality::Counts& counts, quality::Grade grade) {
  if (grade == quality::Grade::fail) return counts.fail;
  return grade == quality::Grade::warn ? counts.warn : counts.ok;
}

/// Updates states and counts for added, changed and removed shells. `touched`: existing shells of `next` that differ.
void judge_again(const Changes& changes, const ShellSet& touched, Generation& next) {
  next.counts.ok += next.model.shell_count() - next.quality.size();
  next.quality.resize(next.model.shell_count());
  for (const ShellIndex shell : changes.removed_shells) {
    --count_of(next.counts, next.quality[shell.value].grade());
    next.quality.set(shell.value, {});
  }
  quality::rejudge(next.model, sized(*next.judging), touched, next.quality, next.counts);
}

/// Existing shells of `after` whose corners or positions differ.
ShellSet touched_shells(const Model& after, const Changes& changes, const NodeSet& moved) {
  ShellSet touched = shells_touching(after, moved);
  touched.insert(touched.end(), changes.added_shells.begin(), changes.added_shells.end());
  touched.insert(touched.end(), changes.reshaped_shells.begin(), changes.reshaped_shells.end());
  std::sort(touched.begin(), touched.end());
  touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
  return touched;
}

void weigh_again(const Generation& before, const Changes& changes, const ShellSet& touched, Generation& next) {
  ShellSet old = touched;
  std::erase_if(old, [&](ShellIndex shell) { return shell.value >= before.model.shell_count() || before.model.is_removed(shell); });
  old.insert(old.end(), changes.removed_shells.begin(), changes.removed_shells.end());
  std::sort(old.begin(), old.end());
  next.weight -= quality::mass_properties(before.model, old);
  next.weight += quality::mass_properties(next.model, touched);
}

/// Those moved nodes of a change whose cards change.
NodeSet moved_of_deck(const Model& opened, const Model& model, const repair::Restructuring& change) {
  NodeSet moved;
  for (const auto& [node, position] : change.moved)
    if (node.value < opened.node_count() && !model.is_removed(node) && position != opened.position(node)) moved.push_back(node);
  return moved;
}

}  // namespace

Result<void> carry_out(const Document& document, const repair::Restructuring& change, Model& model) {
  deck::NewIds ids(*document.deck, model);
  for (const repair::NewNode& node : change.new_nodes) {
    const Result<std::int64_t> id = ids.node(node.origin);
    if (!id) return fail(id.error());
    add_node(model, *id, node.position, node.origin);
  }
  for (const repair::NewShell& shell : change.new_shells) {
    const Result<std::int64_t> id = ids.shell(shell.parent);
    if (!id) return fail(id.error());
    add_shell(model, *id, shell.nodes, shell.parent);
  }
  for (const auto& [shell, nodes] : change.reshaped) set_shell_nodes(model, shell, nodes);
  for (const auto& [node, position] : change.moved) model.positions.set(node.value, position);
  for (const ShellIndex shell : change.removed_shells) remove_shell(model, shell);
  for (const NodeIndex node : change.removed_nodes) remove_node(model, node);
  return deck::can_restructure(*document.deck, document.opened->model, model, moved_of_deck(document.opened->model, model, change));
}

void settle_growth(const Generation& before, const NodeSet& moved, Generation& next) {
  const Changes changes = changes_between(before.model, next.model);
  if (!changes.empty() && !next.model.adjacency)
    next.model.adjacency = std::make_shared<const Adjacency>(update_adjacency(before.model, next.model));
  next.node_marks.resize(next.model.node_count());
  next.shell_marks.resize(next.model.shell_count());
  const ShellSet touched = touched_shells(next.model, changes, moved);
  judge_again(changes, touched, next);
  if (!changes.empty()) next.clusters = clusters_of(*next.judging, next.model);
  weigh_again(before, changes, touched, next);
}

void note_missing_files(const Document& document, const Changes& changes, EditReport& report) {
  const std::vector<std::string>& missing = document.deck->missing_files;
  if (!missing.empty() && changes.added_nodes.size() + changes.added_shells.size() + changes.other_elements() > 0)
    report.notes.push_back(
        "the include file " + missing.front() + (missing.size() > 1 ? " and " + counted(missing.size() - 1, "other") : std::string()) +
        (missing.size() > 1 ? " aren't" : " isn't") + " there; the new nodes and elements may have numbers that it uses");
}

void finish_restructuring(const Document& document, Generation& next, EditReport& report) {
  const Generation& before = document.current();
  const NodeSet moved = moved_nodes(before.model, next.model);
  settle_growth(before, moved, next);
  const Changes changes = changes_between(before.model, next.model);
  carry_selection(changes, next);
  mark_parts_at(corners_of_changed(before.model, next.model, changes), next);
  report.nodes_moved = moved.size();
  report.largest_move = largest_move(before.model, next.model, moved);
  report.elements_added = changes.added_shells.size();
  report.elements_removed = changes.removed_shells.size();
  note_missing_files(document, changes, report);
}

Result<void> restructure(const Document& document, const repair::Restructuring& change, Generation& next, EditReport& report) {
  if (const Result<void> done = carry_out(document, change, next.model); !done) return done;
  finish_restructuring(document, next, report);
  return {};
}

}  // namespace prismesh::mesh::document

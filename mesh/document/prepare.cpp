#include "mesh/document/prepare.h"
#include "mesh/document/edit_kinds.h"

#include <algorithm>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "base/counted.h"
#include "mesh/document/apply.h"
#include "mesh/document/branches.h"
#include "mesh/document/history.h"
#include "mesh/document/part_marks.h"
#include "mesh/document/read_variant.h"
#include "mesh/document/weld_places.h"
#include "mesh/model/node_set.h"
#include "mesh/model/topology_change.h"

namespace prismesh::mesh::document {

namespace {

Result<Prepared> prepare_step(const Document& document, bool back) {
  if (back ? !document.can_undo() : !document.can_redo()) {
    const bool dropped = back && document.generations.front()->made_by != "open";  // not `opened`: saving in place replaces that
    return fail("", std::string("there is nothing to ") + (back ? "undo" : "redo") +
                        (dropped ? " any more: the oldest steps went to keep the history within its size" : ""));
  }
  Prepared prepared;
  prepared.step = back ? Prepared::Step::undo : Prepared::Step::redo;
  prepared.next = document.generations[back ? document.cursor - 1 : document.cursor + 1];
  const Model &from = document.current().model, &to = prepared.next->model;
  const Changes changes = back ? changes_between(to, from) : changes_between(from, to);
  const NodeSet moved = moved_nodes(from, to);
  prepared.report.nodes_moved = moved.size();
  if (!moved.empty()) prepared.report.largest_move = largest_move(from, to, moved);
  const std::size_t others = changes.other_elements();
  prepared.report.elements_added = back ? changes.removed_shells.size() : changes.added_shells.size() + others;
  prepared.report.elements_removed = back ? changes.added_shells.size() + others : changes.removed_shells.size();
  prepared.report.notes.push_back((back ? "undid " : "did again: ") + (back ? document.current() : *prepared.next).made_by);
  return prepared;
}

template <class E>
Result<Prepared> prepare_push(const Document& document, const E& edit, std::string_view edit_name, const Progress& progress);

/// The other deck is read once, so that what is done is what is journalled.
Result<Prepared> prepare_replace(const Document& document, const ReplacePart& edit, std::string_view edit_name, const Progress& progress) {
  Result<ReplacePart> whole = with_mesh(document, edit, progress);
  if (!whole) return fail(whole.error());
  Result<Prepared> prepared = prepare_push(document, *whole, edit_name, progress);
  if (prepared) prepared->as_done = std::move(*whole);
  return prepared;
}

Result<Prepared> prepare_branch(const Document& document, std::uint64_t number) {
  const Branch* branch = find_branch(document, number);
  if (branch == nullptr) return fail("", "the history has no branch " + std::to_string(number));
  if (branch->fork != document.current().number)
    return fail("", "branch " + std::to_string(number) + " leaves from state " + std::to_string(branch->fork) +
                        ": undo or redo to that state first");
  Prepared prepared;
  prepared.step = Prepared::Step::branch;
  prepared.branch = number;
  prepared.next = document.generations[document.cursor];
  prepared.report.notes.push_back("redo now leads to branch " + std::to_string(number));
  return prepared;
}

/// Relaxing and repairing go by what is at fault, also where nobody sees it.
void say_hidden(const Generation& before, const Generation& after, EditReport& report) {
  const std::vector<std::uint8_t> hidden = hidden_parts(after);
  if (hidden.empty()) return;
  std::set<std::int64_t> changed;
  const auto add = [&](ShellIndex shell) {
    const PartIndex part = after.model.shell_parts[shell.value];
    if (part.valid() && part.value < hidden.size() && hidden[part.value] != 0) changed.insert((*after.model.parts)[part.value].id);
  };
  const Changes changes = changes_between(before.model, after.model);
  for (const auto& shells : {changes.added_shells, changes.removed_shells, changes.reshaped_shells}) std::ranges::for_each(shells, add);
  // The nodes of a part that is seen too belong to both.
  for (const ShellIndex shell : shells_touching(before.model, moved_nodes(before.model, after.model))) add(shell);
  if (changed.empty()) return;
  constexpr std::size_t kNamed = 6;
  std::string names;
  std::size_t named = 0;
  for (const std::int64_t id : changed)
    if (named++ < kNamed) names += (names.empty() ? "" : ", ") + std::to_string(id);
  if (changed.size() > kNamed) names += ", ..";
  report.notes.push_back((changed.size() == 1 ? "a hidden part was changed too: " : "hidden parts were changed too: ") + names);
}

void say_dropped(const Document& document, Prepared& prepared) {
  if (prepared.drop_branches > 0)
    prepared.report.notes.push_back("the oldest " +
                                    (prepared.drop_branches == 1 ? "branch" : std::to_string(prepared.drop_branches) + " branches") +
                                    " of the history went: it is kept within " + counted(document.history_bytes, "byte"));
  if (prepared.drop_oldest > 0)
    prepared.report.notes.push_back("the oldest " + counted(prepared.drop_oldest, "step") +
                                    " can't be undone any more: the history is kept within " + counted(document.history_bytes, "byte"));
}

template <class E>
Result<Prepared> prepare_push(const Document& document, const E& edit, std::string_view edit_name, const Progress& progress) {
  const Generation& current = document.current();
  auto next = std::make_shared<Generation>(current);
  Prepared prepared;
  const Result<void> applied = [&] {
    if constexpr (requires { apply_edit(document, edit, *next, prepared.report, progress); })
      return apply_edit(document, edit, *next, prepared.report, progress);
    else
      return apply_edit(document, edit, *next, prepared.report);
  }();
  if (!applied) return fail(applied.error());
  if constexpr (std::is_same_v<E, Repair>)
    if (const std::optional<StoppedRepair>& stopped = prepared.report.stopped) {
      Repair done = edit;
      done.stop_at = StopPoint{stopped->attempt, stopped->steps};
      prepared.as_done = std::move(done);
    }
  if constexpr (std::is_same_v<E, Weld>)
    if (edit.points_file)
      if (Result<Weld> whole = with_points(document, edit)) prepared.as_done = std::move(*whole);
  if constexpr (std::is_same_v<E, Repair> || std::is_same_v<E, Relax>) say_hidden(current, *next, prepared.report);
  next->number = document.next_number;
  next->made_by = edit_name;
  next->own_bytes = own_bytes(current, *next);
  const HistoryExcess excess = excess_with(document, *next);
  prepared.drop_oldest = excess.generations;
  prepared.drop_branches = excess.branches;
  say_dropped(document, prepared);
  prepared.next = std::move(next);
  return prepared;
}

void say_weights(const quality::MassProperties& before, const quality::MassProperties& after, EditReport& report) {
  const auto point = [](const quality::MassProperties& weight) {
    const std::optional<Vec3> at = weight.centre();
    return at ? std::optional<std::array<double, 3>>({at->x(), at->y(), at->z()}) : std::nullopt;
  };
  if (before.shells > 0) report.mass_before = before.mass;
  if (after.shells > 0) report.mass_after = after.mass;
  report.centre_before = point(before);
  report.centre_after = point(after);
}

}  // namespace

Result<Prepared> prepare(const Document& document, const Edit& edit, const Progress& progress, Clock* clock) {
  const std::int64_t start_ns = clock != nullptr ? clock->now_ns() : 0;
  Result<Prepared> prepared = std::visit(
      [&](const auto& each) -> Result<Prepared> {
        using E = std::decay_t<decltype(each)>;
        if constexpr (std::is_same_v<E, Undo> || std::is_same_v<E, Redo>)
          return prepare_step(document, std::is_same_v<E, Undo>);
        else if constexpr (std::is_same_v<E, TakeBranch>)
          return prepare_branch(document, each.number);
        else if constexpr (std::is_same_v<E, ReplacePart>)
          return prepare_replace(document, each, name(edit), progress);
        else
          return prepare_push(document, each, name(edit), progress);
      },
      edit);
  if (!prepared) return prepared;
  prepared->report.edit = name(edit);
  if (const EditReport& done = prepared->report; done.nodes_moved + done.elements_added + done.elements_removed > 0)
    say_weights(document.current().weight, prepared->next->weight, prepared->report);
  if (prepared->report.nodes_moved == 0) prepared->report.largest_move.reset();
  prepared->report.before = document.current().counts;
  prepared->report.after = prepared->next->counts;
  prepared->report.clusters_before = document.current().clusters->size();
  prepared->report.clusters_after = prepared->next->clusters->size();
  if (clock != nullptr) prepared->report.milliseconds = static_cast<double>(clock->now_ns() - start_ns) * 1e-6;
  return prepared;
}

void commit(Document& document, Prepared prepared) {
  switch (prepared.step) {
    case Prepared::Step::undo: --document.cursor; return;
    case Prepared::Step::redo: ++document.cursor; return;
    case Prepared::Step::branch: take_branch(document, prepared.branch); return;
    case Prepared::Step::push: break;
  }
  auto& generations = document.generations;
  put_newer_aside(document);
  document.next_number = prepared.next->number + 1;
  generations.push_back(std::move(prepared.next));
  generations.erase(generations.begin(),
                    generations.begin() + static_cast<std::ptrdiff_t>(std::min(prepared.drop_oldest, generations.size() - 1)));
  document.cursor = generations.size() - 1;
  if (prepared.drop_branches + prepared.drop_oldest > 0) drop_branches(document, prepared.drop_branches);
}

Result<EditReport> apply(Document& document, const Edit& edit, const Progress& progress, Clock* clock) {
  Result<Prepared> prepared = prepare(document, edit, progress, clock);
  if (!prepared) return fail(prepared.error());
  EditReport report = prepared->report;
  commit(document, std::move(*prepared));
  return report;
}

}  // namespace prismesh::mesh::document

#include <algorithm>
#include <array>
#include <iterator>

#include "base/counted.h"
#include "mesh/deck/editing/edit_checks.h"
#include "mesh/document/apply.h"
#include "mesh/document/clusters.h"
#include "mesh/document/restructure.h"
#include "mesh/document/scope.h"
#include "mesh/document/unwritable.h"
#include "mesh/model/topology_change.h"
#include "mesh/repair/manual_operation.h"
#include "mesh/repair/repair.h"

namespace prismesh::mesh::document {

namespace {

constexpr int kMaxAttempts = 5;                ///< to find changes that can be written
constexpr std::size_t kMaxNamedInRepair = 10;  ///< elements that a note names

repair::Options options_of(double angle, const MoveLimits& limits) {
  repair::Options options;
  options.relax.feature_angle = angle;
  options.relax.max_move_on_surface = limits.free;
  options.relax.max_move_on_line = limits.line;
  return options;
}

std::string shell_name(const Model& model, ShellIndex shell) { return "shell:" + std::to_string(model.shell_ids[shell.value]); }

std::string crowded(std::size_t nodes) { return counted(nodes, "node") + " with too many triangles"; }

void note_operations(const repair::Repaired& repaired, EditReport& report) {
  std::string said;
  constexpr std::array<std::string_view, repair::kOperationCount> kDone{"split", "collapsed", "merged", "swapped", "moved"};
  for (std::size_t i = 0; i < repaired.done.size(); ++i)
    if (repaired.done[i] > 0) said += (said.empty() ? "" : ", ") + std::to_string(repaired.done[i]) + " " + std::string(kDone[i]);
  if (repaired.relaxed > 0) said += (said.empty() ? "" : ", ") + counted(repaired.relaxed, "node") + " relaxed";
  if (said.empty()) said = "nothing changed";
  const std::string clusters = repaired.clusters_before > 0 ? " and " + crowded(repaired.clusters_before) : "";
  report.notes.push_back("of " + counted(repaired.bad_before, "element") + " that failed or warned" + clusters + " in the scope: " + said);
}

void note_triangle_pairs(const repair::Repaired& repaired, EditReport& report) {
  report.triangle_pairs = repaired.triangle_pairs;
  if (repaired.triangle_pairs > 0)
    report.notes.push_back(counted(repaired.triangle_pairs, "pair") + " of adjacent triangles " +
                           (repaired.triangle_pairs == 1 ? "stays" : "stay") + ": without them elements would fail");
}

void note_unrepaired(const repair::Repaired& repaired, const Frozen& frozen, const Model& model, EditReport& report) {
  if (repaired.unrepaired.empty()) return;
  report.notes.push_back(counted(repaired.unrepaired.size(), "element") + " still " + (repaired.unrepaired.size() == 1 ? "fails" : "fail"));
  if (repaired.stopped) return;  // most of them weren't tried, so there are no reasons
  for (std::size_t i = 0; i < std::min(repaired.unrepaired.size(), kMaxNamedInRepair); ++i) {
    const repair::Unrepaired& left = repaired.unrepaired[i];
    const auto known = frozen.shells.find(left.shell);
    report.notes.push_back(shell_name(model, left.shell) + ": " +
                           (known == frozen.shells.end() ? left.why : "can't be changed: " + known->second.why));
  }
}

void note_clusters_left(const repair::Repaired& repaired, const Model& model, EditReport& report) {
  const std::vector<repair::ClusterLeft>& left = repaired.clusters_left;
  if (left.empty()) return;
  report.notes.push_back(crowded(left.size()) + (left.size() == 1 ? " stays" : " stay"));
  if (repaired.stopped) return;
  for (std::size_t i = 0; i < std::min(left.size(), kMaxNamedInRepair); ++i)
    report.notes.push_back((left[i].node.valid() ? "node:" + std::to_string(model.node_ids[left[i].node.value]) : "a new node") + ": " +
                           std::to_string(left[i].triangles) + " triangles; " + left[i].why);
}

void note_stop(int attempt, int max_rounds, const repair::Repaired& repaired, EditReport& report) {
  const StoppedRepair stopped{attempt, repaired.stopped->steps, repaired.rounds, max_rounds, repaired.bad_before, repaired.bad_left};
  const std::string of_attempt = attempt > 1 ? " of attempt " + std::to_string(attempt) : "";
  const std::string left =
      stopped.bad_before > 0 ? ", with " + std::to_string(stopped.bad_left) + " of " + counted(stopped.bad_before, "bad element") + " left"
                             : "";
  report.notes.push_back("stopped " + (stopped.round > 0 ? "in round " + std::to_string(stopped.round) : "before round 1") + of_attempt +
                         ", of at most " + std::to_string(max_rounds) + " rounds; kept" + left);
  report.stopped = stopped;
}

/// The words of a further attempt.
Doing further(int attempt, const Doing& doing) {
  if (attempt == 1 || !doing) return doing;
  return [attempt, &doing] { return "attempt " + std::to_string(attempt) + ", " + doing(); };
}

/// What a repair works on and fills in.
struct RepairTask {
  const Document& document;
  const Repair& edit;
  repair::Options options;
  Generation& next;
  EditReport& report;
  NodeSet clusters;  ///< to repair
  Frozen frozen;     ///< shells that must stay as they are, since the deck can't be written otherwise
};

/// The error of a repair that was stopped while the deck couldn't hold what it had reached.
Error stopped_too_early(Error why) {
  why.message = "the repair was stopped, and nothing of it is kept: the deck can't hold what it had reached: " + why.message;
  return why;
}

/// Repairs the scope, and repeats without the changes that can't be written. Errors: cancelled; no set of changes can be written; stopped
/// before one was found.
Result<repair::Repaired> repair_writable(RepairTask& task, const ShellSet& scope, const Progress& progress) {
  auto& [document, edit, options, next, report, clusters, frozen] = task;
  const Generation& current = document.current();
  const relax::ReferenceSurface surface = surface_about(current, scope, options.relax.feature_angle);
  const repair::Rules rules = with_frozen(rules_for(document, current), frozen);
  int attempt = 1;
  bool is_told_to_stop = false;
  double furthest = 0;  // the progress doesn't go back when another attempt begins
  const Progress forward = [&](double fraction, const Doing& doing) {
    furthest = std::max(furthest, fraction);
    if (progress && !progress(furthest, further(attempt, doing))) is_told_to_stop = true;
    return !is_told_to_stop;
  };
  const auto keeps = [&] { return task.edit.on_cancel == OnCancel::keep || progress.keeps(); };
  for (;; ++attempt) {
    options.stop_at.clear();
    if (edit.stop_at && edit.stop_at->attempt == attempt) options.stop_at = edit.stop_at->steps;
    Result<repair::Repaired> repaired =
        repair::repair({current.model, surface, rules, judged_by(document), options, clusters}, scope, forward);
    if (!repaired) return repaired;
    if (is_told_to_stop && !keeps()) return fail(cancelled());
    if (repaired->stopped) note_stop(attempt, options.max_rounds, *repaired, report);
    if (repaired->change.empty()) return repaired;
    Generation trial = current;
    const Result<void> done = restructure(document, repaired->change, trial, report);
    if (done) {
      next = std::move(trial);
      return repaired;
    }
    if (repaired->stopped) return fail(stopped_too_early(done.error()));
    if (attempt == kMaxAttempts) return fail(done.error());
    const Result<std::size_t> found = find_unwritable(document, current.model, repaired->change, frozen, forward);
    if (!found) return fail(keeps() ? stopped_too_early(done.error()) : found.error());
    if (*found == 0) return fail(done.error());
  }
}

}  // namespace

Result<void> apply_edit(const Document& document, const Repair& edit, Generation& next, EditReport& report, const Progress& progress) {
  const Result<ShellSet> scope = shells_in(document, edit.scope, "repair");
  if (!scope) return fail(scope.error());
  const ClustersInScope clusters = clusters_in(document, edit.scope, *scope);
  if (clusters.nodes.empty() && std::all_of(scope->begin(), scope->end(),
                                            [&](ShellIndex shell) { return next.quality[shell.value].grade() == quality::Grade::ok; })) {
    report.notes.push_back(edit.scope == Scope::damaged ? "nothing to repair: no edit made an element fail or warn"
                                                        : "nothing to repair: every element in the scope is fine");
    return {};
  }
  RepairTask task{document, edit, options_of(edit.angle, edit.max_move), next, report, clusters.nodes, {}};
  ShellSet shells;
  std::set_union(scope->begin(), scope->end(), clusters.shells.begin(), clusters.shells.end(), std::back_inserter(shells));
  const Result<repair::Repaired> repaired = repair_writable(task, shells, progress);
  if (!repaired) return fail(repaired.error());
  const Frozen& frozen = task.frozen;
  note_operations(*repaired, report);
  note_triangle_pairs(*repaired, report);
  note_unrepaired(*repaired, frozen, next.model, report);
  note_clusters_left(*repaired, next.model, report);
  for (std::string& note : notes_of(frozen)) report.notes.push_back(std::move(note));
  return {};
}

namespace {

/// The shells and nodes that an operation by hand acts on.
struct HandTargets {
  ShellSet shells;
  NodeSet nodes;
};

/// The shell with an id. `word`: shell, quad or tri. Errors: none, or two, has it.
Result<ShellIndex> find_shell_by_hand(const Model& model, const std::string& word, std::int64_t id) {
  std::vector<ShellIndex> found{model.find_shell(id)};
  if (model.second_shells)
    for (const ShellIndex shell : *model.second_shells)
      if (model.shell_ids[shell.value] == id) found.push_back(shell);
  std::erase_if(
      found, [&](ShellIndex shell) { return !shell.valid() || (word != "shell" && model.shell(shell).is_triangle() != (word == "tri")); });
  const std::string number = std::to_string(id);
  if (found.empty()) return fail("", "there is no " + word + " " + number);
  if (found.size() > 1)
    return fail("", word + " " + number + " is two shells; \"quad:" + number + "\" and \"tri:" + number + "\" name one of them");
  return found.front();
}

Result<HandTargets> find_hand_targets(const Model& model, const Restructure& edit) {
  const std::string what(repair::name(edit.operation));
  HandTargets targets;
  for (const std::string& at : edit.at) {
    const std::size_t colon = at.find(':');
    const std::string kind = at.substr(0, colon), digits = colon == std::string::npos ? "" : at.substr(colon + 1);
    const bool is_id = !digits.empty() && digits.size() <= 18 && digits.find_first_not_of("0123456789") == std::string::npos;
    const bool is_shell = kind == "shell" || kind == "quad" || kind == "tri";
    if (!is_id || (!is_shell && kind != "node")) return fail("", what + ": \"" + at + "\" is neither \"shell:ID\" nor \"node:ID\"");
    const std::int64_t id = std::stoll(digits);
    Result<ShellIndex> shell = ShellIndex();
    if (is_shell && !(shell = find_shell_by_hand(model, kind, id))) return fail("", what + ": " + shell.error().message);
    const NodeIndex node = kind == "node" ? model.find_node(id) : NodeIndex();
    if (!is_shell && !node.valid()) return fail("", what + ": there is no " + kind + " " + digits);
    if (is_shell) targets.shells.push_back(*shell);
    if (node.valid()) targets.nodes.push_back(node);
  }
  if (targets.shells.empty() && targets.nodes.empty()) return fail("", what + ": \"at\" names no shell and no node");
  return targets;
}

/// Refuses to divide a shell that a card forbids to divide; the rules refuse it too, but name no card.
Result<void> refuse_indivisible(const Document& document, const Model& model, const ShellSet& shells) {
  if (!document.deck->references) return {};
  deck::DivisionCheck division(*document.deck);
  for (const ShellIndex shell : shells)
    if (Result<void> may = division.may_be_divided(model.shell_ids[deck_ancestor(model, shell).value]); !may) return may;
  return {};
}

}  // namespace

Result<void> apply_edit(const Document& document, const Restructure& edit, Generation& next, EditReport& report) {
  const Generation& current = document.current();
  const Result<HandTargets> targets = find_hand_targets(current.model, edit);
  if (!targets) return fail(targets.error());
  if (edit.operation == repair::Operation::split)
    if (const Result<void> may = refuse_indivisible(document, current.model, targets->shells); !may) return may;
  const repair::Options options = options_of(30, {});
  NodeSet nodes = targets->nodes;
  std::sort(nodes.begin(), nodes.end());
  ShellSet about = shells_touching(current.model, nodes);
  about.insert(about.end(), targets->shells.begin(), targets->shells.end());
  const relax::ReferenceSurface surface = surface_about(current, about, options.relax.feature_angle);
  const Result<repair::Restructuring> change =
      repair::apply_manual_operation({current.model, surface, rules_for(document, current), judged_by(document), options},
                                     {edit.operation, targets->shells, targets->nodes});
  if (!change) return fail("", std::string(repair::name(edit.operation)) + ": " + change.error().message);
  return restructure(document, *change, next, report);
}

}  // namespace prismesh::mesh::document

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <tuple>

#include "base/counted.h"
#include "mesh/document/apply.h"
#include "mesh/document/clusters.h"
#include "mesh/document/contact_rule.h"
#include "mesh/document/held_apart.h"
#include "mesh/document/history.h"
#include "mesh/document/restructure.h"
#include "mesh/document/scope.h"
#include "mesh/document/unwritable.h"
#include "mesh/model/adjacency.h"
#include "mesh/repair/compose.h"
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

/// What a repair has reached, over its passes.
struct Reached {
  repair::Repaired repaired;  ///< its change is one of the document's current generation; indices are those that it gives
  Frozen frozen;              ///< of the last pass: shells that had to stay as they are, since the deck can't be written otherwise
  Frozen ever_frozen;         ///< of all passes
  std::string held_apart;     ///< of the last pass that held shells back from contacts: how many, and why
  std::shared_ptr<const Generation> generation;  ///< null: nothing has changed
  EditReport figures;                            ///< of applying the change
};

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
  const std::size_t pairs = report.triangle_pairs = repaired.triangle_pairs.size();
  if (pairs > 0)
    report.notes.push_back(counted(pairs, "pair") + " of adjacent triangles " + (pairs == 1 ? "stays" : "stay") +
                           ": without them elements would fail");
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

/// The words of a further pass, or of a further attempt in the first one. `pass`: from 0.
Doing further(int pass, int attempt, const Doing& doing) {
  if ((pass == 0 && attempt == 1) || !doing) return doing;
  return [pass, attempt, &doing] {
    return (pass > 0 ? "pass " + std::to_string(pass + 1) : "attempt " + std::to_string(attempt)) + ", " + doing();
  };
}

/// The error of a repair that was stopped while the deck couldn't hold what it had reached.
Error stopped_too_early(Error why) {
  why.message = "the repair was stopped, and nothing of it is kept: the deck can't hold what it had reached: " + why.message;
  return why;
}

/// The progress of a repair over its passes and attempts.
class RepairProgress {
 public:
  RepairProgress(const Progress& progress, bool keeps) : progress_(progress), keeps_(keeps) {}

  int attempt = 0;  ///< from 1, over all passes
  int pass = 0;

  bool is_told_to_stop() const { return is_told_to_stop_; }
  /// Whether a stop keeps what was reached.
  bool keeps() const { return keeps_ || progress_.keeps(); }
  /// Of an attempt. It doesn't go back when another attempt begins; each pass counts as most of what is left.
  bool report(double fraction, const Doing& doing) {
    furthest_ = std::max(furthest_, 1 - std::pow(1 - kShareOfPass, pass) * (1 - kShareOfPass * fraction));
    if (progress_ && !progress_(furthest_, further(pass, attempt, doing))) is_told_to_stop_ = true;
    return !is_told_to_stop_;
  }

 private:
  static constexpr double kShareOfPass = 0.7;
  const Progress& progress_;
  bool keeps_;
  bool is_told_to_stop_ = false;
  double furthest_ = 0;
};

/// What a pass works on.
struct PassInput {
  const Document& document;  ///< whose current generation it repairs
  const Repair& edit;
  const repair::Options& options;
  const ShellSet& scope;
  const NodeSet& clusters;
  const ContactsOf* contacts;  ///< that it must not add to; null: none is looked for
};

/// What a pass made of the generation that it began with.
struct Pass {
  repair::Repaired repaired;
  Frozen frozen;
  HeldApart held;
  std::shared_ptr<const Generation> generation;  ///< null: nothing has changed
  EditReport figures;
};

/// What a pass makes of the contacts of a change that can be written.
enum class Verdict : std::uint8_t { keep, again };

/// Errors: contacts are refused; the repair was stopped, so that it can't go on without the shells that made them.
Result<Verdict> judge_contacts(const PassInput& input, const Generation& trial, Pass& pass) {
  if (input.contacts == nullptr) return Verdict::keep;
  const std::vector<contact::NewContact> made = input.contacts->new_in(trial);
  if (made.empty()) return Verdict::keep;
  if (input.edit.contact == ContactRule::refuse) return fail(refused_contact("repair", trial.model, made));
  if (pass.repaired.stopped) return fail("", "the repair was stopped, and nothing of it is kept: " + contact::in_words(trial.model, made));
  pass.held.hold(input.document.current().model, pass.repaired.change, trial.model, made);
  return Verdict::again;
}

/// Repairs the scope, and repeats without the changes that can't be written or make contacts that they must not. Errors: cancelled; no set
/// of changes can be written; stopped before one was found; as judge_contacts.
Result<Pass> repair_writable(const PassInput& input, RepairProgress& progress) {
  const Document& document = input.document;
  const Generation& current = document.current();
  Pass pass;
  repair::Options options = input.options;
  const relax::ReferenceSurface surface = surface_about(current, input.scope, options.relax.feature_angle);
  const repair::Rules rules = pass.held.with(with_frozen(rules_for(document, current), pass.frozen));
  const Progress forward = [&](double fraction, const Doing& doing) { return progress.report(fraction, doing); };
  for (int tries = 1;;) {
    ++progress.attempt;
    options.stop_at.clear();
    if (input.edit.stop_at && input.edit.stop_at->attempt == progress.attempt) options.stop_at = input.edit.stop_at->steps;
    Result<repair::Repaired> repaired =
        repair::repair({current.model, surface, rules, judged_by(document), options, input.clusters}, input.scope, forward);
    if (!repaired) return fail(repaired.error());
    if (progress.is_told_to_stop() && !progress.keeps()) return fail(cancelled());
    pass.repaired = std::move(*repaired);
    if (pass.repaired.change.empty()) return pass;
    Generation trial = current;
    pass.figures = {};
    const Result<void> done = restructure(document, pass.repaired.change, trial, pass.figures);
    if (done) {
      const Result<Verdict> verdict = judge_contacts(input, trial, pass);
      if (!verdict) return fail(verdict.error());
      if (*verdict == Verdict::again) continue;
      pass.generation = std::make_shared<const Generation>(std::move(trial));
      return pass;
    }
    if (pass.repaired.stopped) return fail(stopped_too_early(done.error()));
    if (tries++ == kMaxAttempts) return fail(done.error());
    const Result<std::size_t> found = find_unwritable(document, current.model, pass.repaired.change, pass.frozen, forward);
    if (!found) return fail(progress.keeps() ? stopped_too_early(done.error()) : found.error());
    if (*found == 0) return fail(done.error());
  }
}

/// Keeps those pairs that are still edges between two triangles.
void keep_pairs_of(const Model& model, std::vector<repair::NodePair>& pairs) {
  std::erase_if(pairs, [&](const repair::NodePair& pair) {
    if (!pair.first.valid() || !pair.second.valid()) return true;
    const EdgeIndex edge = model.adjacency->find_edge(pair.first, pair.second);
    if (!edge.valid()) return true;
    const auto shells = model.adjacency->shells_of(edge);
    return shells.size() != 2 || !model.shell(shells[0]).is_triangle() || !model.shell(shells[1]).is_triangle();
  });
}

/// Adds a pass to what was reached before, as one change. Errors: the deck can't hold that.
Result<void> add_pass(const Document& document, Pass pass, Reached& reached) {
  const Model& model = document.current().model;
  repair::Repaired& all = reached.repaired;
  if (reached.generation == nullptr) {
    const std::size_t bad_before = all.bad_before, clusters_before = all.clusters_before;
    all = std::move(pass.repaired);
    std::tie(all.bad_before, all.clusters_before) = std::tie(bad_before, clusters_before);
    reached.generation = std::move(pass.generation);
    reached.figures = std::move(pass.figures);
    reached.frozen = std::move(pass.frozen);
    return {};
  }
  repair::Composition both = repair::compose(model, all.change, pass.repaired.change);
  Generation next = document.current();
  EditReport figures;
  if (Result<void> done = restructure(document, both.change, next, figures); !done) return done;
  const auto node_index = [&](NodeIndex& node) {
    if (node.valid() && node.value >= model.node_count()) node = both.new_node_index[node.value - model.node_count()];
  };
  const auto shell_index = [&](ShellIndex shell) {
    return shell.value < model.shell_count() ? shell : both.new_shell_index[shell.value - model.shell_count()];
  };
  repair::Repaired& more = pass.repaired;
  all.triangle_pairs.insert(all.triangle_pairs.end(), more.triangle_pairs.begin(), more.triangle_pairs.end());
  for (auto& [a, b] : all.triangle_pairs) {
    node_index(a);
    node_index(b);
  }
  keep_pairs_of(next.model, all.triangle_pairs);
  all.unrepaired = std::move(more.unrepaired);
  for (repair::Unrepaired& left : all.unrepaired) left.shell = shell_index(left.shell);
  all.clusters_left = std::move(more.clusters_left);
  for (repair::ClusterLeft& left : all.clusters_left) node_index(left.node);
  for (std::size_t i = 0; i < all.done.size(); ++i) all.done[i] += more.done[i];
  all.relaxed = both.change.moved.size();
  all.bad_left = more.bad_left;
  all.rounds = more.rounds;
  all.stopped = std::move(more.stopped);
  all.change = std::move(both.change);
  reached.frozen = {};
  for (auto& [shell, held] : pass.frozen.shells) reached.frozen.shells[shell_index(shell)] = std::move(held);
  reached.generation = std::make_shared<const Generation>(std::move(next));
  reached.figures = std::move(figures);
  return {};
}

/// Adds what a pass says that changed nothing: why the rest stays.
void add_reasons(Pass pass, Reached& reached) {
  repair::Repaired& all = reached.repaired;
  all.unrepaired = std::move(pass.repaired.unrepaired);
  all.clusters_left = std::move(pass.repaired.clusters_left);
  all.bad_left = pass.repaired.bad_left;
  all.rounds = pass.repaired.rounds;
  all.stopped = std::move(pass.repaired.stopped);
  reached.frozen = std::move(pass.frozen);
}

/// Repairs in passes, until one changes nothing: so that the repair of what a repair has left does nothing.
/// Errors: as repair_writable, of the first pass; cancelled.
Result<Reached> repair_in_passes(const Document& document, const Repair& edit, RepairProgress& progress) {
  repair::Options options = options_of(edit.angle, edit.max_move);
  options.moves_from = &document.current().model;
  std::optional<ContactsOf> contacts;
  if (edit.contact.value_or(ContactRule::allow) != ContactRule::allow) contacts.emplace(document.current());
  Reached reached;
  Document at = document;
  for (;; ++progress.pass) {
    const Result<ShellSet> scope = shells_in(at, edit.scope, "repair");
    if (!scope) return fail(scope.error());
    const ClustersInScope clusters = clusters_in(at, edit.scope, *scope);
    const bool is_done = clusters.nodes.empty() && std::all_of(scope->begin(), scope->end(), [&](ShellIndex shell) {
                           return at.current().quality[shell.value].grade() == quality::Grade::ok;
                         });
    if (is_done) return reached;
    ShellSet shells;
    std::set_union(scope->begin(), scope->end(), clusters.shells.begin(), clusters.shells.end(), std::back_inserter(shells));
    Result<Pass> pass = repair_writable({at, edit, options, shells, clusters.nodes, contacts ? &*contacts : nullptr}, progress);
    // A stop must end as its replay does, which has no other place to stop at: so the passes before can't be kept either.
    if (!pass && (progress.pass == 0 || is_cancelled(pass.error()) || progress.is_told_to_stop())) return fail(pass.error());
    if (!pass) return reached;
    for (const auto& [shell, held] : pass->frozen.shells)
      if (shell.value < document.current().model.shell_count()) reached.ever_frozen.shells.insert({shell, held});
    if (std::string note = pass->held.note(); !note.empty()) reached.held_apart = std::move(note);
    if (progress.pass == 0) {
      reached.repaired.bad_before = pass->repaired.bad_before;
      reached.repaired.clusters_before = pass->repaired.clusters_before;
    }
    const bool is_stopped = pass->repaired.stopped.has_value();
    if (pass->repaired.change.empty()) {
      add_reasons(std::move(*pass), reached);
      return reached;
    }
    const Result<void> added = add_pass(document, std::move(*pass), reached);
    if (!added && is_stopped) return fail(stopped_too_early(added.error()));
    if (!added || is_stopped) return reached;
    at = with_current(document, reached.generation);
  }
}

}  // namespace

Result<void> apply_edit(const Document& document, const Repair& edit, Generation& next, EditReport& report, const Progress& progress) {
  RepairProgress repair_progress(progress, edit.on_cancel == OnCancel::keep);
  Result<Reached> reached = repair_in_passes(document, edit, repair_progress);
  if (!reached) return fail(reached.error());
  if (repair_progress.attempt == 0) {
    report.notes.push_back(edit.scope == Scope::damaged ? "nothing to repair: no edit made an element fail or warn"
                                                        : "nothing to repair: every element in the scope is fine");
    return {};
  }
  const repair::Repaired& repaired = reached->repaired;
  if (repaired.stopped) note_stop(repair_progress.attempt, repair::Options().max_rounds, repaired, report);
  if (reached->generation != nullptr) {
    next = *reached->generation;
    report.nodes_moved = reached->figures.nodes_moved;
    report.largest_move = reached->figures.largest_move;
    report.elements_added = reached->figures.elements_added;
    report.elements_removed = reached->figures.elements_removed;
    report.notes.insert(report.notes.end(), reached->figures.notes.begin(), reached->figures.notes.end());
  }
  note_operations(repaired, report);
  note_triangle_pairs(repaired, report);
  note_unrepaired(repaired, reached->frozen, next.model, report);
  note_clusters_left(repaired, next.model, report);
  if (!reached->held_apart.empty()) report.notes.push_back(std::move(reached->held_apart));
  for (std::string& note : notes_of(reached->ever_frozen)) report.notes.push_back(std::move(note));
  return {};
}

}  // namespace prismesh::mesh::document

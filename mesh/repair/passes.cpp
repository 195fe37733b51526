#include "mesh/repair/passes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "mesh/relax/relax.h"
#include "mesh/repair/acceptance.h"
#include "mesh/repair/candidates.h"
#include "mesh/repair/change_history.h"
#include "mesh/repair/clusters.h"
#include "mesh/repair/strips.h"
#include "mesh/repair/trial.h"

namespace prismesh::mesh::repair {

namespace {

constexpr int kMaxStripPasses = 4;

/// Reports the share of the round that is done; false: the repair was cancelled. The number of rounds isn't known before: each counts as
/// 40 % of what is left.
bool reports(RoundProgress& progress, double done) {
  if (!progress.stopped && progress.progress && !progress.progress(1 - std::pow(0.6, progress.round + done)))
    progress.stopped = cancelled();
  return !progress.stopped;
}

/// Begins a step, and reports as above; false: the repair was cancelled, or stops here as asked. Counts the same steps each time.
bool goes_on(RoundProgress& progress, double done) {
  if (progress.stopped) return false;
  ++progress.step;
  if (progress.stop_at && progress.step >= *progress.stop_at) progress.stopped = cancelled();
  return reports(progress, done);
}

/// One pass over the strips at bad shells.
bool divide_strips_once(const RepairContext& context, RepairState& state) {
  const Patch& patch = context.patch;
  bool better = false;
  std::set<std::pair<LocalShell, int>> refused;  ///< a refused strip isn't tried again from each of its shells
  for (const LocalShell shell : bad_shells(patch, state.history, quality::Grade::warn))
    for (int edge = 0; edge < 2; ++edge) {
      if (!patch.shell(shell).is_alive || patch.shell(shell).state.grade() == quality::Grade::ok) break;
      if (refused.contains({shell, edge})) continue;
      const std::vector<Candidate> found = strips_for(context, shell, edge);
      if (found.empty()) continue;
      if (!goes_on(state.progress, 0)) return false;
      if (improve(context, state, found, shell, TrialGoal::cure))
        better = true;
      else
        for (const StripQuad& quad : path_of(patch, {shell, edge}).quads) refused.emplace(quad.shell, quad.edge);
    }
  return better;
}

/// Whether something near a shell changed since all of its candidates were refused.
bool is_worth_trying(const Patch& patch, const RepairState& state, LocalShell shell) {
  const auto refused = state.record.refused_at.find(shell);
  return refused == state.record.refused_at.end() || changed_nearby(patch, state.history, shell, refused->second);
}

/// Nodes that relaxing may move: of shells that are bad or were changed, and of those about them.
NodeSet movable_nodes(const Patch& patch, const ChangeHistory& history) {
  std::vector<std::uint8_t> near(patch.node_count(), 0);
  for (std::size_t s = 0; s < patch.shell_count(); ++s) {
    const LocalShell shell(s);
    if (!patch.shell(shell).is_alive) continue;
    const bool is_bad = patch.shell(shell).state.grade() != quality::Grade::ok && is_in_scope(history, shell);
    if (!is_bad && !is_changed(patch, history, shell)) continue;
    for (const LocalNode corner : patch.shell(shell).corners)
      for (const LocalShell other : patch.node(corner).shells)
        for (const LocalNode node : patch.shell(other).corners) near[node.value] = 1;
  }
  NodeSet nodes;
  for (std::size_t n = 0; n < near.size(); ++n) {
    const PatchNode& node = patch.node(LocalNode(n));
    if (near[n] != 0 && node.is_alive && node.is_whole && (node.rules & kStays) == 0 && !node.is_off_surface) nodes.push_back(NodeIndex(n));
  }
  return nodes;
}

/// Where each node of the patch was in the model: max moves count from there. A new node has no such place.
std::vector<Vec3> positions_in_model(const Patch& patch) {
  std::vector<Vec3> positions;
  for (std::size_t n = 0; n < patch.node_count(); ++n) {
    const NodeIndex node = patch.node(LocalNode(n)).model;
    positions.push_back(node.valid() ? patch.model().position(node) : Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
  }
  return positions;
}

}  // namespace

bool divide_strips(const RepairContext& context, RepairState& state) {
  int pass = 0;
  for (; pass < kMaxStripPasses && divide_strips_once(context, state); ++pass) relax_neighbourhood(context, state);
  return pass > 0;
}

bool repair_clusters(const RepairContext& context, RepairState& state) {
  return thin_clusters(context, state, [&] { return goes_on(state.progress, 0); });
}

bool cure_shells(const RepairContext& context, RepairState& state, quality::Grade min_grade, double done) {
  const Patch& patch = context.patch;
  bool better = false;
  const std::vector<LocalShell> bad = bad_shells(patch, state.history, min_grade);
  const double each = kSweepShare / static_cast<double>(std::max<std::size_t>(bad.size(), 1));
  for (const LocalShell shell : bad) {
    if (!goes_on(state.progress, done)) break;
    done += each;
    if (!patch.shell(shell).is_alive || patch.shell(shell).state.grade() < min_grade || !is_worth_trying(patch, state, shell)) continue;
    if (improve(context, state, candidates_for(context, shell), shell, TrialGoal::cure))
      better = true;
    else
      state.record.refused_at[shell] = state.history.changes;
  }
  return better;
}

bool split_failing_quads(const RepairContext& context, RepairState& state) {
  const Patch& patch = context.patch;
  bool better = false;
  for (const LocalShell shell : bad_shells(patch, state.history, quality::Grade::fail)) {
    if (!goes_on(state.progress, 1)) break;
    if (!patch.shell(shell).is_alive || patch.shell(shell).state.fail == 0) continue;
    better = improve(context, state, splits_of(context, shell), shell, TrialGoal::split) || better;
  }
  if (better) tidy_triangles(context, state, 1);
  return better;
}

void tidy_triangles(const RepairContext& context, RepairState& state, double done) {
  const Patch& patch = context.patch;
  for (std::size_t s = 0; s < patch.shell_count(); ++s) {
    const LocalShell shell(s);
    if (!patch.shell(shell).is_alive || !is_changed(patch, state.history, shell) || corner_count(patch.shell(shell).corners) != 3) continue;
    if (!goes_on(state.progress, done)) return;
    improve(context, state, tidying_for(context, shell), shell, TrialGoal::tidy);
  }
}

void relax_neighbourhood(const RepairContext& context, RepairState& state) {
  if (!goes_on(state.progress, 0)) return;
  // The last relaxation was taken back, and it would be the same again.
  if (state.relaxing_refused_at == state.history.changes) return;
  Patch& patch = context.patch;
  std::vector<LocalShell> shells;
  const Model small = patch.as_model(shells);
  const std::vector<Vec3> at_first = positions_in_model(patch);
  relax::Options options = context.options.relax;
  options.checks_before_rest = false;
  options.move_origins = &at_first;
  const Result<relax::Relaxed> relaxed =
      relax::relax({small, context.surface, context.criteria, options}, movable_nodes(patch, state.history),
                   [&](double) { return reports(state.progress, 0); });
  if (!relaxed) {
    state.progress.stopped = relaxed.error();
    return;
  }
  patch.begin();
  for (std::size_t i = 0; i < relaxed->nodes.size(); ++i) patch.move(LocalNode(relaxed->nodes[i].value), relaxed->positions[i]);
  judge_shells(context, patch.changed_shells());
  if (adds_failures(patch) || !conforms(patch)) {
    patch.take_back();
    state.relaxing_refused_at = state.history.changes;
  } else {
    keep_change(patch, state.history);
  }
}

}  // namespace prismesh::mesh::repair

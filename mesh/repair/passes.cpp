#include "mesh/repair/passes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "mesh/relax/relax.h"
#include "mesh/repair/acceptance.h"
#include "mesh/repair/candidates.h"
#include "mesh/repair/change_history.h"
#include "mesh/repair/clusters.h"
#include "mesh/repair/placement.h"
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

/// Whether something near a shell changed since all of its candidates were refused.
bool is_worth_trying(const Patch& patch, const ChangeHistory& history, const std::map<LocalShell, std::uint32_t>& refused_at,
                     LocalShell shell) {
  const auto refused = refused_at.find(shell);
  return refused == refused_at.end() || changed_nearby(patch, history, shell, refused->second);
}

/// Whether a strip changed since it was refused.
bool is_strip_worth_trying(const RepairState& state, const StripCandidates& strip) {
  const auto& refused_at = state.record.strip_refused_at[state.along_lines ? 1 : 0];
  const auto refused = refused_at.find({strip.operation, strip.quads});
  return refused == refused_at.end() || std::any_of(strip.quads.begin(), strip.quads.end(), [&](const StripQuad& quad) {
           return last_change(state.history, quad.shell) > refused->second;
         });
}

/// One pass over the strips at bad shells.
bool divide_strips_once(const RepairContext& context, RepairState& state) {
  const Patch& patch = context.patch;
  bool better = false;
  for (const LocalShell shell : bad_shells(patch, state.history, quality::Grade::warn))
    for (int edge = 0; edge < 2; ++edge) {
      if (!patch.shell(shell).is_alive || patch.shell(shell).state.grade() == quality::Grade::ok) break;
      std::vector<StripCandidates> strips = strips_for(context, shell, edge);
      std::erase_if(strips, [&](const StripCandidates& strip) { return !is_strip_worth_trying(state, strip); });
      if (strips.empty()) continue;
      if (!goes_on(state.progress, 0)) return false;
      std::vector<Candidate> found;
      for (const StripCandidates& strip : strips) found.insert(found.end(), strip.candidates.begin(), strip.candidates.end());
      if (improve(context, state, found, shell, TrialGoal::cure)) {
        better = true;
        continue;
      }
      for (StripCandidates& strip : strips)
        state.record.strip_refused_at[state.along_lines ? 1 : 0][{strip.operation, std::move(strip.quads)}] = state.history.changes;
    }
  return better;
}

/// Whether an operation made or reshaped a triangle, or it has an edge in common with a shell that was bad at first.
bool may_be_tidied(const Patch& patch, const ChangeHistory& history, LocalShell triangle) {
  if (is_reshaped(patch, history, triangle)) return true;
  const Corners& corners = patch.shell(triangle).corners;
  for (std::size_t i = 0; i < 3; ++i)
    for (const LocalShell at_edge : patch.shells_at(corners[i], corners[(i + 1) % 3]))
      if (was_bad(history, at_edge)) return true;
  return false;
}

bool is_to_tidy(const Patch& patch, const ChangeHistory& history, LocalShell shell) {
  return patch.shell(shell).is_alive && corner_count(patch.shell(shell).corners) == 3 && may_be_tidied(patch, history, shell);
}

/// Tidies triangles by the best candidate of all of them, again and again: after a split, many would make the same pairs fewer, and what is
/// left depends on their order. Each step costs the candidates of all triangles, so it is done only while these are few.
/// Returns whether they are.
bool tidy_best_first(const RepairContext& context, RepairState& state) {
  constexpr std::size_t kMaxTriangles = 64;
  for (bool better = true; better;) {
    std::vector<LocalShell> triangles;
    for (std::size_t s = 0; s < context.patch.shell_count(); ++s)
      if (is_to_tidy(context.patch, state.history, LocalShell(s))) triangles.push_back(LocalShell(s));
    if (triangles.size() > kMaxTriangles) return false;
    if (triangles.empty() || !goes_on(state.progress, 1)) return true;
    std::vector<Candidate> all;
    for (const LocalShell shell : triangles)
      for (Candidate& candidate : tidying_for(context, shell)) all.push_back(std::move(candidate));
    better = improve(context, state, all, triangles.front(), TrialGoal::tidy);
  }
  return true;
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

/// Where the max move of each node of the patch counts from. A new node has no such place.
std::vector<Vec3> move_origins(const RepairContext& context) {
  std::vector<Vec3> positions;
  for (std::size_t n = 0; n < context.patch.node_count(); ++n)
    positions.push_back(move_origin(context, LocalNode(n)).value_or(Vec3::Constant(std::numeric_limits<double>::quiet_NaN())));
  return positions;
}

/// Moves nodes and judges the shells about them. Nodes of shells that are folded, fail anew, or warn anew unless they may, go back, until
/// there is no such shell. Returns whether any node has moved.
bool move_where_acceptable(const RepairContext& context, std::vector<std::pair<LocalNode, Vec3>> moves, bool may_warn) {
  Patch& patch = context.patch;
  const auto is_worse = [&](LocalShell shell, const PatchShell& was) {
    const quality::Grade grade = patch.shell(shell).state.grade();
    return grade > was.state.grade() && !(may_warn && grade == quality::Grade::warn);
  };
  while (!moves.empty()) {
    for (const auto& [node, place] : moves) patch.move(node, place);
    judge_shells(context, patch.changed_shells());
    std::set<LocalNode> back;
    for (const auto& [shell, was] : patch.old_shells())
      if (is_worse(shell, was) || !conforms(patch, shell))
        for (const LocalNode corner : patch.shell(shell).corners) back.insert(corner);
    if (std::erase_if(moves, [&](const auto& move) { return back.contains(move.first); }) == 0) break;
    patch.take_back();
    patch.begin();
  }
  return !moves.empty();
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
    if (!patch.shell(shell).is_alive || patch.shell(shell).state.grade() < min_grade) continue;
    if (!is_worth_trying(patch, state.history, state.record.refused_at, shell)) continue;
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
  if (!better) return false;
  if (!tidy_best_first(context, state)) tidy_triangles(context, state, 1);
  return true;
}

bool heal_failing_shells(const RepairContext& context, RepairState& state) {
  const Patch& patch = context.patch;
  bool better = false;
  // Each success leaves fewer failing shells, so this ends.
  for (bool again = true; again;) {
    again = false;
    for (const LocalShell shell : bad_shells(patch, state.history, quality::Grade::fail)) {
      if (!goes_on(state.progress, 1)) return better;
      if (!patch.shell(shell).is_alive || patch.shell(shell).state.fail == 0) continue;
      again = improve(context, state, single_operations_at(context, shell), shell, TrialGoal::heal) || again;
    }
    better = better || again;
  }
  return better;
}

void tidy_triangles(const RepairContext& context, RepairState& state, double done) {
  const Patch& patch = context.patch;
  for (std::size_t s = 0; s < patch.shell_count(); ++s) {
    const LocalShell shell(s);
    if (!is_to_tidy(patch, state.history, shell)) continue;
    if (!is_worth_trying(patch, state.history, state.record.tidying_refused_at, shell)) continue;
    if (!goes_on(state.progress, done)) return;
    if (!improve(context, state, tidying_for(context, shell), shell, TrialGoal::tidy))
      state.record.tidying_refused_at[shell] = state.history.changes;
  }
}

void relax_neighbourhood(const RepairContext& context, RepairState& state) {
  if (!goes_on(state.progress, 0)) return;
  // The last relaxation was taken back, and it would be the same again.
  if (state.relaxing_refused_at == state.history.changes) return;
  Patch& patch = context.patch;
  std::vector<LocalShell> shells;
  const Model small = patch.as_model(shells);
  const std::vector<Vec3> at_first = move_origins(context);
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
  std::vector<std::pair<LocalNode, Vec3>> moves;
  for (std::size_t i = 0; i < relaxed->nodes.size(); ++i) moves.emplace_back(LocalNode(relaxed->nodes[i].value), relaxed->positions[i]);
  patch.begin();
  // Where no operation helps any more, other places of the nodes let some help again, even if shells warn until then.
  if (!move_where_acceptable(context, std::move(moves), state.effort.along_lines)) {
    patch.take_back();
    state.relaxing_refused_at = state.history.changes;
  } else {
    keep_moves(patch, state.history);
  }
}

}  // namespace prismesh::mesh::repair

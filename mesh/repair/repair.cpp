#include "mesh/repair/repair.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <string_view>
#include <tuple>
#include <utility>

#include "base/tasks.h"
#include "mesh/repair/acceptance.h"
#include "mesh/repair/change_history.h"
#include "mesh/repair/clusters.h"
#include "mesh/repair/merge.h"
#include "mesh/repair/passes.h"
#include "mesh/repair/pieces.h"
#include "mesh/repair/pieces_progress.h"

namespace prismesh::mesh::repair {

namespace {

constexpr int kRingsOfPatch = 4;
constexpr long kTriangleFactorOfSplits = 2;  ///< times the max number of triangles, where only halves of a failing quad pass

std::size_t triangles_in(const Model& model) {
  std::size_t triangles = 0;
  for (std::size_t c = 0; c < model.shell_nodes.chunk_count(); ++c)
    for (const ShellNodes& nodes : model.shell_nodes.chunk(c)) triangles += nodes.is_triangle() && nodes.node[0].valid() ? 1 : 0;
  return triangles;
}

/// Limits a little inside of those given: a deck's fields hold fewer digits than the model, so that saving moves nodes slightly.
quality::Limits with_margin(quality::Limits limits) {
  constexpr float kMargin = 1e-3F;
  for (quality::ShapeLimits* shape : {&limits.quad, &limits.triangle})
    for (quality::Threshold& threshold : shape->threshold) {
      const auto tighten = [](float& limit, float toward) {
        if (std::isfinite(limit)) limit += toward * kMargin * std::abs(limit);
      };
      tighten(threshold.warn_low, 1);
      tighten(threshold.fail_low, 1);
      tighten(threshold.warn_high, -1);
      tighten(threshold.fail_high, -1);
    }
  return limits;
}

quality::LimitsByPart with_margin(quality::LimitsByPart limits) {
  for (quality::Limits& each : limits.distinct) each = with_margin(each);
  return limits;
}

/// What every piece of a repair begins with: the triangles that are there and those that may be there.
struct TriangleLimits {
  long now = 0;
  long may_be_added = 0;
  long may_be_added_by_split = 0;
};

TriangleLimits triangle_limits(const Model& model, double max_triangles_percent) {
  const auto now = static_cast<long>(triangles_in(model));
  const auto allowed = static_cast<long>(max_triangles_percent / 100 * static_cast<double>(live_shells(model)));
  return {now, std::max(allowed - now, 0L), std::max(kTriangleFactorOfSplits * allowed - now, 0L)};
}

ChangeHistory history_of(const Patch& patch, const ShellSet& scope, const TriangleLimits& limits) {
  ChangeHistory history;
  history.in_scope.assign(patch.shell_count(), 0);
  for (std::size_t s = 0; s < patch.shell_count(); ++s)
    history.in_scope[s] = std::binary_search(scope.begin(), scope.end(), patch.shell(LocalShell(s)).model) ? 1 : 0;
  history.triangles = limits.now;
  history.max_triangles = limits.now + limits.may_be_added;
  history.max_triangles_by_split = limits.now + limits.may_be_added_by_split;
  return history;
}

/// Judges all live shells of the patch by the context's limits.
void judge_all(const RepairContext& context) {
  Patch& patch = context.patch;
  patch.begin();
  std::vector<LocalShell> all;
  for (std::size_t s = 0; s < patch.shell_count(); ++s)
    if (patch.shell(LocalShell(s)).is_alive) all.push_back(LocalShell(s));
  judge_shells(context, all);
  patch.keep();
}

/// One round of all passes. Returns whether a shell got better.
bool run_round(const RepairContext& context, RepairState& state) {
  bool better = false;
  // A node that moved along a line hinders the next strip, which would divide the line evenly: so lines keep their nodes in a first pass.
  state.along_lines = false;
  better = repair_clusters(context, state) || better;
  better = divide_strips(context, state) || better;
  if (state.effort.along_lines) {
    state.along_lines = true;
    better = divide_strips(context, state) || better;
  }
  // Shells that fail first; then those that warn.
  better = cure_shells(context, state, quality::Grade::fail, kStripShare) || better;
  better = cure_shells(context, state, quality::Grade::warn, kStripShare + kSweepShare) || better;
  tidy_triangles(context, state, kStripShare + 2 * kSweepShare);
  return better;
}

/// What is left where rounds don't help: splits of failing quads; then single operations on failing shells. Returns whether one helped.
bool help_last(const RepairContext& context, RepairState& state) {
  return split_failing_quads(context, state) || heal_failing_shells(context, state);
}

/// How bad a piece is: its failing shells, then its warnings and the triangles above the max at its nodes.
struct Badness {
  std::size_t failing = 0;
  double other = 0;
  bool operator<(const Badness& than) const { return std::tie(failing, other) < std::tie(than.failing, than.other); }
};

constexpr double kTriangleTooMany = 4;  ///< counts as so many warnings: thinning a cluster may make some shells warn

Badness badness_of(const RepairContext& context, const RepairState& state) {
  Badness badness;
  for (std::size_t s = 0; s < context.patch.shell_count(); ++s) {
    const PatchShell& shell = context.patch.shell(LocalShell(s));
    if (!shell.is_alive) continue;
    badness.failing += shell.state.grade() == quality::Grade::fail ? 1 : 0;
    badness.other += shell.state.grade() == quality::Grade::warn ? 1 : 0;
  }
  for (const ClusterLeft& cluster : clusters_left(context, state))
    badness.other += kTriangleTooMany * (static_cast<double>(cluster.triangles) - state.clusters.allowed);
  return badness;
}

/// Rounds until a thorough one makes nothing better and no failing quad has halves that pass, the options' limit, or the
/// repair is cancelled. Returns how many.
int run_rounds(const RepairContext& context, RepairState& state) {
  int rounds = 0;
  std::optional<std::size_t> failing_before;  // at the last thorough round
  Badness best = badness_of(context, state);
  relax_neighbourhood(context, state);
  for (int& round = state.progress.round; round < context.options.max_rounds && !state.progress.stopped; ++round) {
    rounds = round + 1;
    const bool better = run_round(context, state);
    const bool is_thorough = state.effort.along_lines;
    if (is_thorough) {
      // Rounds may go in a circle: relaxing makes shells warn, and operations help these again. So it counts what fails.
      const std::size_t failing = bad_shells(context.patch, state.history, quality::Grade::fail).size();
      const bool is_stuck = !better || (failing_before && failing >= *failing_before);
      failing_before = failing;
      if (is_stuck) help_last(context, state);
      const Badness now = badness_of(context, state);
      if (!(now < best)) break;
      best = now;
    }
    // A round that made nothing better is followed by a thorough one, which tries every shell again.
    state.effort = better || is_thorough ? kQuickEffort : kThoroughEffort;
    if (!better) state.record.forget_refused();
    // After a split its triangles are joined and moved away first, while the nodes are where they were.
    if (better || !is_thorough) relax_neighbourhood(context, state);
  }
  heal_failing_shells(context, state);
  return rounds;
}

/// Why a shell still fails.
std::string_view reason_of(const Patch& patch, const TrialRecord& record, LocalShell shell) {
  const Corners& corners = patch.shell(shell).corners;
  const auto is_held = [&](LocalNode n) { return !patch.node(n).lines.empty() || patch.node(n).freedom != relax::Freedom::surface; };
  if (std::all_of(corners.begin(), corners.end(), is_held)) return "it lies between edges of the part that have to stay";
  const auto reason = record.reason.find(shell);
  return reason == record.reason.end() ? "no operation makes it better" : reason->second;
}

std::vector<Unrepaired> unrepaired_shells(const Patch& patch, const RepairState& state, const std::vector<ShellIndex>& index_of) {
  std::vector<Unrepaired> unrepaired;
  for (const LocalShell shell : bad_shells(patch, state.history, quality::Grade::fail))
    unrepaired.push_back({index_of[shell.value], std::string(reason_of(patch, state.record, shell))});
  std::sort(unrepaired.begin(), unrepaired.end(), [](const Unrepaired& a, const Unrepaired& b) { return a.shell < b.shell; });
  return unrepaired;
}

/// The edges between two triangles that aren't among `before`.
std::vector<NodePair> added_pairs(const Patch& patch, const std::vector<std::pair<LocalNode, LocalNode>>& before,
                                  const std::vector<NodeIndex>& index_of) {
  std::vector<NodePair> added;
  for (const auto& edge : pair_edges(patch))
    if (!std::binary_search(before.begin(), before.end(), edge))
      added.emplace_back(index_of[edge.first.value], index_of[edge.second.value]);
  return added;
}

/// The limits that all shells are judged by.
struct LimitsOfRepair {
  quality::LimitsByPart exact;
  quality::LimitsByPart strict;  ///< while the repair goes on
};

/// A repair before it is divided into pieces.
struct WholeRepair {
  const RepairInput& input;
  const ShellSet& scope;
  LimitsOfRepair limits;
  ClusterState clusters;
  TriangleLimits triangles;
  std::size_t bad_before = 0;
  std::vector<Piece> pieces;
};

WholeRepair divide_repair(const RepairInput& input, const ShellSet& scope) {
  WholeRepair whole{input, scope, {quality::limits_for(input.criteria), {}}, cluster_state_of(input), {}, 0, {}};
  whole.limits.strict = with_margin(whole.limits.exact);
  whole.triangles = triangle_limits(input.model, input.options.max_triangles_percent);
  Patch patch(input.model, scope, kRingsOfPatch, input.rules, input.options.relax.feature_angle);
  const ChangeHistory history = history_of(patch, scope, whole.triangles);
  judge_all({patch, input.surface, input.criteria, input.options, whole.limits.exact});
  whole.bad_before = bad_shells(patch, history, quality::Grade::warn).size();
  const RepairContext strict{patch, input.surface, input.criteria, input.options, whole.limits.strict};
  judge_all(strict);
  whole.pieces = pieces_of(strict, history, input.clusters);
  return whole;
}

std::optional<std::uint64_t> stop_of(const Options& options, std::size_t piece) {
  if (piece >= options.stop_at.size() || options.stop_at[piece] == 0) return std::nullopt;
  return options.stop_at[piece];
}

/// What a piece of a repair works on.
struct PieceWork {
  Patch patch;
  RepairState state;
};

/// Gives up what a repair did that made nothing better.
void give_up(PieceWork& work, Patch at_first, ChangeHistory history) {
  work.patch = std::move(at_first);
  work.state.history = std::move(history);
  work.state.record.accepted = {};
}

/// What has become of a piece. `pairs_before`: pair_edges at first.
Repaired result_of(const RepairContext& exact, const RepairState& state, const std::vector<std::pair<LocalNode, LocalNode>>& pairs_before) {
  PatchResult result = exact.patch.result();
  Repaired repaired;
  if (state.progress.stopped) repaired.stopped = StoppedAt{{state.progress.step}};
  repaired.bad_left = state.progress.bad_left();
  repaired.relaxed = result.change.moved.size();
  repaired.done = state.record.accepted;
  repaired.clusters_left = clusters_left(exact, state);
  repaired.triangle_pairs = added_pairs(exact.patch, pairs_before, result.node_index);
  repaired.unrepaired = unrepaired_shells(exact.patch, state, result.shell_index);
  repaired.change = std::move(result.change);
  return repaired;
}

/// Repairs one piece, which may add the triangles of `share`. When it is stopped, it returns what it has reached. If that is no better than
/// the piece was, nothing of it is kept: so a repair of what a repair left does nothing, unless it helps.
Result<Repaired> repair_piece(const WholeRepair& whole, std::size_t piece, const TriangleLimits& share, PiecesProgress& pieces,
                              const std::function<void()>& wake) {
  const RepairInput& input = whole.input;
  const RoundProgress* round = nullptr;
  const Progress progress = pieces.of(piece, wake, [&] { return PieceStatus{round->round + 1, round->bad_left()}; });
  PieceWork work{Patch(input.model, whole.pieces[piece].shells, 0, input.rules, input.options.relax.feature_angle),
                 RepairState{.history = {}, .record = {}, .progress = {progress, stop_of(input.options, piece)}}};
  auto& [patch, state] = work;
  state.history = history_of(patch, whole.scope, share);
  state.clusters = whole.clusters;
  round = &state.progress;
  state.progress.bad_left = [&work] { return bad_shells(work.patch, work.state.history, quality::Grade::warn).size(); };
  const RepairContext exact{patch, input.surface, input.criteria, input.options, whole.limits.exact};
  const RepairContext strict{patch, input.surface, input.criteria, input.options, whole.limits.strict};
  judge_all(strict);
  const Patch patch_before = patch;
  const ChangeHistory history_before = state.history;
  const Badness bad_before = badness_of(strict, state);
  const auto pairs_before = pair_edges(patch);
  state.history.was_bad.assign(patch.shell_count(), 0);
  for (const LocalShell bad : bad_shells(patch, state.history, quality::Grade::warn)) state.history.was_bad[bad.value] = 1;
  const int rounds = run_rounds(strict, state);
  if (state.progress.stopped && !is_cancelled(*state.progress.stopped)) return fail(*state.progress.stopped);
  if (!(badness_of(strict, state) < bad_before)) {
    give_up(work, patch_before, history_before);
    // On what stays as it was, no single operation was tried yet.
    heal_failing_shells(strict, state);
  }
  judge_all(exact);
  Repaired repaired = result_of(exact, state, pairs_before);
  repaired.rounds = rounds;
  return repaired;
}

/// The shares of the triangles that may be added, by piece.
std::vector<TriangleLimits> triangle_shares(const WholeRepair& whole) {
  const std::vector<long> shares = shares_of(whole.pieces, whole.triangles.may_be_added);
  const std::vector<long> shares_by_split = shares_of(whole.pieces, whole.triangles.may_be_added_by_split);
  std::vector<TriangleLimits> limits;
  for (std::size_t i = 0; i < shares.size(); ++i) limits.push_back({whole.triangles.now, shares[i], shares_by_split[i]});
  return limits;
}

/// The numbers of the pieces, those with the most work first: so that the last thread to end has little left.
std::vector<std::size_t> by_work(const std::vector<Piece>& pieces) {
  std::vector<std::size_t> order(pieces.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return pieces[a].work > pieces[b].work; });
  return order;
}

}  // namespace

Result<Repaired> repair(const RepairInput& input, const ShellSet& scope, const Progress& progress) {
  const WholeRepair whole = divide_repair(input, scope);
  const std::vector<TriangleLimits> shares = triangle_shares(whole);
  const std::vector<std::size_t> order = by_work(whole.pieces);
  PiecesProgress all_progress(whole.pieces, progress);
  std::vector<Result<Repaired>> results(whole.pieces.size());
  run_tasks(
      order.size(), input.options.max_threads,
      [&](std::size_t i, const std::function<void()>& wake) {
        const std::size_t piece = order[i];
        results[piece] = repair_piece(whole, piece, shares[piece], all_progress, wake);
        all_progress.ended(piece, results[piece] ? results[piece]->bad_left : 0, wake);
      },
      [&] { all_progress.report(); });
  std::vector<Repaired> repaired;
  for (Result<Repaired>& result : results) {
    if (!result) return fail(result.error());
    repaired.push_back(std::move(*result));
  }
  Repaired all = merge(input.model, repaired);
  all.bad_before = whole.bad_before;
  all.clusters_before = input.clusters.size();
  return all;
}

}  // namespace prismesh::mesh::repair

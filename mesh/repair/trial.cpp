#include "mesh/repair/trial.h"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

#include "mesh/repair/acceptance.h"
#include "mesh/repair/change_history.h"
#include "mesh/repair/clusters.h"
#include "mesh/repair/node_smoothing.h"
#include "mesh/repair/smoothness.h"

namespace prismesh::mesh::repair {

namespace {

constexpr double kMinGain = 0.05;
constexpr int kPreviewSweeps = 1;
constexpr double kMinPreviewGain = -2;  ///< candidates that gain less in the preview get no full trial

// Gains with TrialGoal::split and heal: of each shell that passes and that doesn't warn any more, and cost of a triangle above the max at
// a node. A failing shell outweighs all else. What else the halves are like doesn't count, so that of two equal splits the first is taken.
constexpr double kPassing = 100, kNotWarning = 1, kCrowded = 1;

// Of changes that leave nothing failing or warning the smoother one is preferred: the gain grows by this share for each degree of facets
// less, by this share at most.
constexpr double kSmoother = 0.01, kMaxSmoother = 0.3;

constexpr int kTrianglesRank = 5;  ///< of the reasons that count triangles: above all others

struct Outcome {
  double gain = 0;  ///< in cost; 0: not acceptable
  std::string_view why;
  int rank = 0;  ///< of several reasons the one of the highest rank is reported
};

/// By how much the change lowers the cost of the shells that it touches.
double gain_now(const RepairContext& context) {
  judge_shells(context, context.patch.changed_shells());
  return cost_before(context.patch).total - cost_now(context.patch).total;
}

double min_gain_at_first(const RepairState& state, const Patch& patch) {
  return state.effort.min_gain_at_first * static_cast<double>(patch.changed_shells().size());
}

/// The gain of a candidate after little smoothing; nothing if it can't be applied, or is so bad at first that smoothing can't help. A
/// candidate that tidies triangles is always smoothed: it has to be applied before it can look better.
std::optional<double> preview(const RepairContext& context, const RepairState& state, const Candidate& candidate, TrialGoal goal,
                              Outcome& reason) {
  Patch& patch = context.patch;
  patch.begin();
  std::optional<double> gain;
  if (const Refusal refusal = candidate.apply()) {
    if (reason.rank < 0) reason = {0, *refusal, 0};
  } else if (goal == TrialGoal::tidy || gain_now(context) > min_gain_at_first(state, patch)) {
    smooth_nodes(context, kPreviewSweeps, state.along_lines);
    gain = gain_now(context);
  }
  patch.take_back();
  return gain;
}

/// Whether it is tried only where nothing else helps: nodes stay, pairs of triangles may be made, and each candidate is tried.
bool is_last_resort(TrialGoal goal) { return goal == TrialGoal::split || goal == TrialGoal::heal; }

/// Whether the shells that changed got better in the way that the goal asks for.
bool reaches(TrialGoal goal, const Cost& before, const Cost& now) {
  if (goal == TrialGoal::tidy) return now.failing <= before.failing && now.warning <= before.warning;
  if (is_last_resort(goal)) return now.failing < before.failing;
  const bool cures = now.failing + now.warning < before.failing + before.warning;
  return now.failing < before.failing || now.worst >= before.worst + (cures ? -1e-4F : 1e-3F);
}

double gain_of_split(const Patch& patch, const RepairState& state, const Cost& before, const Cost& now) {
  return kPassing * (before.failing - now.failing) + kNotWarning * (before.warning - now.warning) +
         kCrowded * thinned_by(patch, state.clusters);
}

/// The gain of an acceptable change after which all shells pass: more if it makes the mesh smoother, less if more faceted.
double with_preference(const RepairContext& context, double gain) {
  const double smoother = kSmoother * (facets_before(context) - facets_now(context));
  return gain * (1 + std::clamp(smoother, -kMaxSmoother, kMaxSmoother));
}

/// Applies a candidate to the patch in full, and tells whether the change is acceptable.
Outcome try_out(const RepairContext& context, const RepairState& state, const Candidate& candidate, TrialGoal goal) {
  const Patch& patch = context.patch;
  const ChangeHistory& history = state.history;
  if (const Refusal refusal = candidate.apply()) return {0, *refusal, 0};
  if (!is_last_resort(goal)) smooth_nodes(context, state.effort.sweeps, state.along_lines);
  judge_shells(context, patch.changed_shells());
  const Cost before = cost_before(patch), now = cost_now(patch);
  const double gain = is_last_resort(goal) ? gain_of_split(patch, state, before, now) : before.total - now.total;
  if (gain < kMinGain) return {0, "no operation makes it better", 4};
  if (!reaches(goal, before, now)) return goal == TrialGoal::tidy ? Outcome{} : Outcome{0, "no operation makes it better", 4};
  if (adds_failures(patch)) return {0, "every operation makes a neighbour fail", 2};
  if (goal == TrialGoal::heal && has_new_failure(patch)) return {0, "every operation makes a neighbour fail", 2};
  if (!conforms(patch)) return {0, "every operation would tear or fold the mesh", 1};
  const long max_triangles = is_last_resort(goal) ? history.max_triangles_by_split : history.max_triangles;
  if (now.triangles > before.triangles && history.triangles + now.triangles - before.triangles > max_triangles)
    return {0, "there would be too many triangles", kTrianglesRank};
  if (!is_last_resort(goal) && now.triangle_pairs > before.triangle_pairs &&
      history.added_triangle_pairs + now.triangle_pairs - before.triangle_pairs > 0)
    return {0, "there would be two triangles side by side", kTrianglesRank};
  // The halves of a warped quad are as near to the surface as the quad: it fills the space between its diagonals.
  if (!is_last_resort(goal) && !stays_on_surface(context)) return {0, "every operation leaves the surface", 3};
  // Where quads were split, the shells before are far from the smooth surface, so that the check above allows much.
  if (!is_last_resort(goal) && history.added_triangle_pairs > 0 && !keeps_peaks(context))
    return {0, "every operation leaves the surface", 3};
  const bool is_valid = now.failing == 0 && now.warning == 0;
  return {is_last_resort(goal) || !is_valid ? gain : with_preference(context, gain), {}, 0};
}

/// Candidates worth a full trial, by descending gain in the preview. Splits, whose nodes stay, are all tried, in their order.
std::vector<const Candidate*> promising_of(const RepairContext& context, const RepairState& state, const std::vector<Candidate>& candidates,
                                           TrialGoal goal, Outcome& reason) {
  std::vector<const Candidate*> promising;
  if (is_last_resort(goal)) {
    for (const Candidate& candidate : candidates) promising.push_back(&candidate);
    return promising;
  }
  std::vector<std::pair<double, const Candidate*>> rated;
  for (const Candidate& candidate : candidates)
    if (const auto gain = preview(context, state, candidate, goal, reason); gain && *gain > kMinPreviewGain)
      rated.emplace_back(*gain, &candidate);
  std::stable_sort(rated.begin(), rated.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  for (const auto& [gain, candidate] : rated) promising.push_back(candidate);
  return promising;
}

/// The acceptable candidate with the highest gain; null if there is none.
const Candidate* best_candidate(const RepairContext& context, const RepairState& state, const std::vector<const Candidate*>& promising,
                                TrialGoal goal, Outcome& reason) {
  const Candidate* best = nullptr;
  double max_gain = 0;
  for (std::size_t i = 0; i < promising.size(); ++i) {
    if (!is_last_resort(goal) && i >= (best != nullptr ? state.effort.max_trials_once_found : state.effort.max_trials)) break;
    context.patch.begin();
    const Outcome outcome = try_out(context, state, *promising[i], goal);
    context.patch.take_back();
    if (outcome.gain > max_gain * 1.0001) {
      max_gain = outcome.gain;
      best = promising[i];
    }
    if (outcome.rank > reason.rank) reason = outcome;
  }
  return best;
}

}  // namespace

bool improve(const RepairContext& context, RepairState& state, const std::vector<Candidate>& candidates, LocalShell shell, TrialGoal goal) {
  Outcome reason{0, "no operation is possible", -1};
  const std::vector<const Candidate*> promising = promising_of(context, state, candidates, goal, reason);
  const Candidate* best = best_candidate(context, state, promising, goal, reason);
  if (best == nullptr) {
    if (goal == TrialGoal::cure || (is_last_resort(goal) && reason.rank == kTrianglesRank)) state.record.reason[shell] = reason.why;
    return false;
  }
  context.patch.begin();
  try_out(context, state, *best, goal);
  keep_change(context.patch, state.history);
  if (best->operation) ++state.record.accepted[static_cast<std::size_t>(*best->operation)];
  return true;
}

}  // namespace prismesh::mesh::repair

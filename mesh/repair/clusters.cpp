#include "mesh/repair/clusters.h"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "mesh/model/adjacency.h"
#include "mesh/quality/triangle_clusters.h"
#include "mesh/repair/acceptance.h"
#include "mesh/repair/candidates.h"
#include "mesh/repair/change_history.h"
#include "mesh/repair/collapse.h"
#include "mesh/repair/node_smoothing.h"
#include "mesh/repair/redivide.h"

namespace prismesh::mesh::repair {

namespace {

constexpr double kCrowding = 0.5;  ///< cost of a triangle more than allowed at a node; a warning costs 1
constexpr double kMinThinningGain = 0.05;
constexpr int kThinningPreviewSweeps = 1;
constexpr std::size_t kMaxThinningTrials = 8;  ///< full trials for a set of candidates
constexpr int kMaxChangesAtNode = 24;
constexpr std::string_view kNoReason = "no operation takes triangles away";

/// The first reason is told: that of the simplest operation.
void tell(std::string_view& why, std::string_view reason) {
  if (why == kNoReason) why = reason;
}

/// Whether triangles of the part count.
bool counts_part(const ClusterState& clusters, PartIndex part) {
  const std::size_t last = clusters.meant.size() - 1;
  return clusters.meant[part.valid() ? std::min<std::size_t>(part.value, last) : last] == 0;
}

bool counts_in_clusters(const ClusterState& clusters, const PatchShell& shell) {
  return corner_count(shell.corners) == 3 && counts_part(clusters, shell.part);
}

bool counts_in_model(const Model& model, const ClusterState& clusters, ShellIndex shell) {
  return model.shell(shell).is_triangle() && counts_part(clusters, model.shell_parts[shell.value]);
}

/// The triangles about a node, also those outside of the patch.
long triangles_about(const Patch& patch, const ClusterState& clusters, LocalNode node) {
  long count = 0;
  for (const LocalShell shell : patch.node(node).shells) count += counts_in_clusters(clusters, patch.shell(shell)) ? 1 : 0;
  if (patch.node(node).is_whole || !patch.node(node).model.valid()) return count;
  const Model& model = patch.model();
  for (const ShellIndex shell : model.adjacency->shells_of(patch.node(node).model))
    count += !patch.find(shell).valid() && counts_in_model(model, clusters, shell) ? 1 : 0;
  return count;
}

/// The triangles about a node in the model; of a new node 0.
long triangles_at_first(const Patch& patch, const ClusterState& clusters, LocalNode node) {
  const NodeIndex of_model = patch.node(node).model;
  if (!of_model.valid()) return 0;
  const Model& model = patch.model();
  long count = 0;
  for (const ShellIndex shell : model.adjacency->shells_of(of_model)) count += counts_in_model(model, clusters, shell) ? 1 : 0;
  return count;
}

double excess_of(long triangles, double allowed) { return std::max(0.0, static_cast<double>(triangles) - allowed); }

bool is_crowded(const Patch& patch, const ClusterState& clusters, LocalNode node) {
  return patch.node(node).is_alive && static_cast<double>(triangles_about(patch, clusters, node)) > clusters.allowed;
}

bool was_in_scope(const Patch& patch, const ClusterState& clusters, LocalNode node) {
  return std::binary_search(clusters.in_scope.begin(), clusters.in_scope.end(), patch.node(node).model);
}

/// The crowded nodes to repair, those with the most triangles first.
std::vector<LocalNode> crowded_nodes(const Patch& patch, const ClusterState& clusters) {
  std::vector<std::pair<long, LocalNode>> found;
  for (std::size_t n = 0; n < patch.node_count(); ++n) {
    const LocalNode node(n);
    if (!is_crowded(patch, clusters, node)) continue;
    const long triangles = triangles_about(patch, clusters, node);
    if (was_in_scope(patch, clusters, node) || triangles > triangles_at_first(patch, clusters, node)) found.emplace_back(triangles, node);
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<LocalNode> nodes;
  for (const auto& [triangles, node] : found) nodes.push_back(node);
  return nodes;
}

/// Crowded nodes to repair, then those of the scope that were crowded.
std::vector<LocalNode> nodes_to_thin(const Patch& patch, const ClusterState& clusters) {
  std::vector<LocalNode> nodes = crowded_nodes(patch, clusters);
  const std::set<LocalNode> crowded(nodes.begin(), nodes.end());
  for (const NodeIndex in_scope : clusters.in_scope)
    if (const LocalNode node = patch.find(in_scope); node.valid() && patch.node(node).is_alive && !crowded.contains(node))
      nodes.push_back(node);
  return nodes;
}

/// What a change that thins may do to other shells.
enum class Price : std::uint8_t { no_worse, may_warn };

struct Thinning {
  double gain = 0;  ///< in cost; 0: not acceptable
  std::string_view why;
};

/// Applies a candidate, smooths the nodes that it touched in `sweeps`, and tells whether the change is acceptable.
Thinning try_thinning(const RepairContext& context, const RepairState& state, const Candidate& candidate, Price price, int sweeps) {
  const Patch& patch = context.patch;
  if (const Refusal refusal = candidate.apply()) return {0, *refusal};
  if (sweeps > 0) smooth_nodes(context, sweeps, state.along_lines);
  judge_shells(context, patch.changed_shells());
  const Cost before = cost_before(patch), now = cost_now(patch);
  const double thinned = thinned_by(patch, state.clusters);
  const double gain = before.total - now.total + kCrowding * thinned;
  const bool is_thinner = thinned > 0 || (thinned == 0 && gain >= kMinThinningGain && now.triangles <= before.triangles);
  if (!is_thinner) return {0, kNoReason};
  if (adds_failures(patch) || now.failing > before.failing) return {0, "every operation makes a neighbour fail"};
  if (price == Price::no_worse && now.warning > before.warning) return {0, "every operation makes a neighbour warn"};
  if (price == Price::may_warn && thinned <= 0) return {0, kNoReason};
  if (!conforms(patch)) return {0, "every operation would tear or fold the mesh"};
  if (now.triangles > before.triangles) return {0, "there would be more triangles"};
  if (!stays_on_surface(context)) return {0, "every operation leaves the surface"};
  // Where quads were split, the shells before are far from the smooth surface, so that the check above allows much.
  if (state.history.added_triangle_pairs > 0 && !keeps_peaks(context)) return {0, "every operation leaves the surface"};
  return {10 * thinned + std::max(gain, 0.0) + 1e-6, {}};
}

/// The gain of a candidate after little smoothing; nothing if it can't be applied.
std::optional<double> preview_thinning(const RepairContext& context, const RepairState& state, const Candidate& candidate,
                                       std::string_view& why) {
  Patch& patch = context.patch;
  patch.begin();
  std::optional<double> gain;
  if (const Refusal refusal = candidate.apply()) {
    tell(why, *refusal);
  } else {
    smooth_nodes(context, kThinningPreviewSweeps, state.along_lines);
    judge_shells(context, patch.changed_shells());
    const double thinned = thinned_by(patch, state.clusters);
    if (thinned >= 0) gain = cost_before(patch).total - cost_now(patch).total + kCrowding * thinned;
  }
  patch.take_back();
  return gain;
}

/// Carries out a candidate and keeps it if it is acceptable; else `why` says why not.
bool keep_if_acceptable(const RepairContext& context, RepairState& state, const Candidate& candidate, Price price, int sweeps,
                        std::string_view& why) {
  context.patch.begin();
  const Thinning outcome = try_thinning(context, state, candidate, price, sweeps);
  if (outcome.gain <= 0) {
    tell(why, outcome.why);
    context.patch.take_back();
    return false;
  }
  keep_change(context.patch, state.history);
  if (candidate.operation) ++state.record.accepted[static_cast<std::size_t>(*candidate.operation)];
  return true;
}

/// Carries out the best acceptable candidate and keeps it. Returns whether there was one; else `why` says why not.
bool carry_out_best(const RepairContext& context, RepairState& state, const std::vector<Candidate>& candidates, Price price,
                    std::string_view& why) {
  std::vector<std::pair<double, const Candidate*>> rated;
  for (const Candidate& candidate : candidates)
    if (const auto gain = preview_thinning(context, state, candidate, why)) rated.emplace_back(*gain, &candidate);
  std::stable_sort(rated.begin(), rated.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  rated.resize(std::min(rated.size(), kMaxThinningTrials));
  const Candidate* best = nullptr;
  double max_gain = 0;
  for (const auto& [expected, candidate] : rated) {
    context.patch.begin();
    const Thinning outcome = try_thinning(context, state, *candidate, price, state.effort.sweeps);
    context.patch.take_back();
    if (outcome.gain > max_gain * 1.0001) {
      max_gain = outcome.gain;
      best = candidate;
    } else if (outcome.gain <= 0) {
      tell(why, outcome.why);
    }
  }
  if (best == nullptr) return false;
  return keep_if_acceptable(context, state, *best, price, state.effort.sweeps, why);
}

/// The triangles about a node that count.
std::vector<LocalShell> triangles_of(const Patch& patch, const ClusterState& clusters, LocalNode node) {
  std::vector<LocalShell> triangles;
  for (const LocalShell shell : patch.node(node).shells)
    if (counts_in_clusters(clusters, patch.shell(shell))) triangles.push_back(shell);
  return triangles;
}

using Pair = std::pair<LocalShell, LocalShell>;

bool is_live_triangle(const Patch& patch, LocalShell shell) {
  return patch.shell(shell).is_alive && corner_count(patch.shell(shell).corners) == 3;
}

/// The pairs of a triangle with each triangle beside it, the lower one first.
void add_pairs(const Patch& patch, LocalShell triangle, std::vector<Pair>& found) {
  const Corners& corners = patch.shell(triangle).corners;
  for (std::size_t i = 0; i < 3; ++i) {
    const LocalNode a = corners[i], b = corners[(i + 1) % 3];
    if (patch.line(a, b) != nullptr) continue;
    for (const LocalShell other : patch.shells_at(a, b))
      if (other != triangle && is_live_triangle(patch, other)) found.emplace_back(std::minmax(triangle, other));
  }
}

Candidate join_of(const RepairContext& context, const Pair& pair) {
  return {Operation::merge, [&context, pair]() -> Refusal {
            const Patch& patch = context.patch;
            if (!is_live_triangle(patch, pair.first) || !is_live_triangle(patch, pair.second)) return "they are triangles no more";
            const Loop loop = loop_of(patch, pair.first, pair.second);
            if (loop.size() != 4) return "they have no edge in common";
            return redivide(context, pair.first, pair.second, {loop});
          }};
}

/// The composite of the quad that a pair makes as its nodes lie; nothing if they can't be joined.
std::optional<float> composite_joined(const RepairContext& context, const Pair& pair) {
  Patch& patch = context.patch;
  patch.begin();
  std::optional<float> composite;
  if (!join_of(context, pair).apply()) {
    const std::vector<LocalShell> changed = patch.changed_shells();
    judge_shells(context, changed);
    composite = 1;
    for (const LocalShell shell : changed) composite = std::min(*composite, patch.shell(shell).composite);
  }
  patch.take_back();
  return composite;
}

/// Joins pairs of triangles at the nodes, those that make the best quads first. So a node's best pair isn't split by another node's. Nodes
/// stay where they are if that is acceptable.
bool join_best_pairs(const RepairContext& context, RepairState& state, Price price, const std::function<bool()>& goes_on) {
  std::vector<Pair> pairs;
  for (const LocalNode node : nodes_to_thin(context.patch, state.clusters))
    for (const LocalShell shell : context.patch.node(node).shells)
      if (counts_in_clusters(state.clusters, context.patch.shell(shell))) add_pairs(context.patch, shell, pairs);
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  std::vector<std::pair<float, Pair>> rated;
  for (const Pair& pair : pairs)
    if (const auto composite = composite_joined(context, pair)) rated.emplace_back(*composite, pair);
  std::stable_sort(rated.begin(), rated.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  bool better = false;
  std::string_view why;
  for (const auto& [composite, pair] : rated) {
    if (!goes_on()) break;
    if (!is_live_triangle(context.patch, pair.first) || !is_live_triangle(context.patch, pair.second)) continue;
    const Candidate join = join_of(context, pair);
    better = keep_if_acceptable(context, state, join, price, 0, why) ||
             keep_if_acceptable(context, state, join, price, state.effort.sweeps, why) || better;
  }
  return better;
}

/// Collapses of the edges of triangles at a node, which take the node or a neighbour away.
void add_collapses_at(const RepairContext& context, LocalNode node, const std::vector<LocalShell>& triangles,
                      std::vector<Candidate>& found) {
  std::vector<LocalNode> ends;
  for (const LocalShell triangle : triangles)
    for (std::size_t i = 0; i < 3; ++i) ends.push_back(context.patch.shell(triangle).corners[i]);
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  for (const LocalNode end : ends) {
    if (end == node) continue;
    if (const auto pair = collapse_of(context, node, end))
      found.push_back({Operation::collapse, [&context, pair = *pair] { return collapse_nodes(context, {pair}); }});
  }
}

/// One change at a node: a join, else another division of two shells or a row, else a collapse.
bool thin_node(const RepairContext& context, RepairState& state, LocalNode node, Price price, std::string_view& why) {
  const std::vector<LocalShell> triangles = triangles_of(context.patch, state.clusters, node);
  std::vector<Candidate> joins, divisions, collapses;
  std::vector<Pair> pairs;
  for (const LocalShell triangle : triangles) add_pairs(context.patch, triangle, pairs);
  for (const Pair& pair : pairs) joins.push_back(join_of(context, pair));
  if (carry_out_best(context, state, joins, price, why)) return true;
  if (!is_crowded(context.patch, state.clusters, node)) return false;
  for (const LocalShell triangle : triangles)
    for (Candidate& candidate : tidying_for(context, triangle)) divisions.push_back(std::move(candidate));
  if (carry_out_best(context, state, divisions, price, why)) return true;
  add_collapses_at(context, node, triangles, collapses);
  return carry_out_best(context, state, collapses, price, why);
}

std::string_view reason_at(const Patch& patch, const ClusterState& clusters, LocalNode node) {
  const std::vector<LocalShell> triangles = triangles_of(patch, clusters, node);
  const auto has_to_stay = [&](LocalShell shell) { return (patch.shell(shell).rules & (kKeepsNodes | kLasting)) != 0; };
  if (std::all_of(triangles.begin(), triangles.end(), has_to_stay)) return "its triangles have to stay as they are";
  const auto reason = clusters.reason.find(node);
  return reason == clusters.reason.end() ? kNoReason : reason->second;
}

}  // namespace

ClusterState cluster_state_of(const RepairInput& input) {
  ClusterState clusters;
  clusters.allowed = input.criteria.criteria.warn_triangles_at_node;
  clusters.meant = quality::meshes_of_triangles(input.model);
  clusters.in_scope = input.clusters;
  return clusters;
}

double thinned_by(const Patch& patch, const ClusterState& clusters) {
  std::map<LocalNode, long> more;  // by node: triangles now, less those before
  const auto add = [&](const PatchShell& shell, long by) {
    if (!counts_in_clusters(clusters, shell)) return;
    for (std::size_t c = 0; c < 3; ++c) more[shell.corners[c]] += by;
  };
  for (const LocalShell shell : patch.changed_shells()) add(patch.shell(shell), 1);
  for (const auto& [shell, was] : patch.old_shells()) add(was, -1);
  double thinned = 0;
  for (const auto& [node, by] : more) {
    if (by == 0) continue;
    const long now = triangles_about(patch, clusters, node);
    thinned += excess_of(now - by, clusters.allowed) - excess_of(now, clusters.allowed);
  }
  return thinned;
}

bool thin_clusters(const RepairContext& context, RepairState& state, const std::function<bool()>& goes_on) {
  bool better = false;
  for (const Price price : {Price::no_worse, Price::may_warn}) {
    if (!goes_on()) return better;
    better = join_best_pairs(context, state, price, goes_on) || better;
    for (const LocalNode node : nodes_to_thin(context.patch, state.clusters)) {
      std::string_view why = kNoReason;
      for (int change = 0; change < kMaxChangesAtNode; ++change) {
        if (!goes_on()) return better;
        if (!context.patch.node(node).is_alive || !thin_node(context, state, node, price, why)) break;
        better = true;
      }
      state.clusters.reason[node] = why;
    }
  }
  return better;
}

std::vector<ClusterLeft> clusters_left(const RepairContext& context, const RepairState& state) {
  std::vector<ClusterLeft> left;
  for (const LocalNode node : crowded_nodes(context.patch, state.clusters)) {
    left.push_back({context.patch.node(node).model, static_cast<std::size_t>(triangles_about(context.patch, state.clusters, node)),
                    std::string(reason_at(context.patch, state.clusters, node))});
  }
  std::sort(left.begin(), left.end(), [](const ClusterLeft& a, const ClusterLeft& b) { return a.node < b.node; });
  return left;
}

}  // namespace prismesh::mesh::repair

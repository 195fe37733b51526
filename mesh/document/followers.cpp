#include "mesh/document/followers.h"

#include <algorithm>

#include "mesh/document/deck_relations.h"
#include "mesh/document/edge_middles.h"
#include "mesh/model/adjacency.h"
#include "mesh/spatial/closest_point.h"

namespace prismesh::mesh::document {

WeightedNodes find_weighted(const Model& model, const shape::Weights& weights) {
  const std::vector<EdgeMiddle> middles = middles_in(model, weights.nodes, shells_touching(model, weights.nodes));
  const auto moves = [&](NodeIndex node) {
    const auto at = std::lower_bound(weights.nodes.begin(), weights.nodes.end(), node);
    return at != weights.nodes.end() && *at == node && weights.weight[static_cast<std::size_t>(at - weights.nodes.begin())] > 0;
  };
  WeightedNodes weighted;
  auto middle = middles.begin();
  for (std::size_t i = 0; i < weights.nodes.size(); ++i) {
    while (middle != middles.end() && middle->node < weights.nodes[i]) ++middle;
    if (middle != middles.end() && middle->node == weights.nodes[i]) {
      ++weighted.reached_middles;
    } else if (weights.weight[i] > 0) {
      weighted.nodes.push_back(weights.nodes[i]);
    }
  }
  for (const EdgeMiddle& each : middles)
    if (moves(each.end[0]) || moves(each.end[1]))
      weighted.middles.push_back({each.node, {each.end[0], each.end[1], NodeIndex(), NodeIndex()}, {0.5, 0.5, 0, 0}});
  return weighted;
}

namespace {

FollowerNode follower_of(const Model& model, NodeIndex node, const spatial::SurfacePoint& on) {
  FollowerNode follower{node, {}, {}};
  const ShellNodes& corners = model.shell(on.shell);
  for (std::size_t i = 0; i < static_cast<std::size_t>(corners.corners()); ++i) {
    if (on.share[i] == 0) continue;
    follower.leader[i] = corners.node[i];
    follower.share[i] = on.share[i];
  }
  return follower;
}

}  // namespace

std::vector<FollowerNode> find_weld_followers(const Generation& generation, const NodeSet& moving) {
  return find_weld_followers(generation, generation.model, moving);
}

std::vector<FollowerNode> find_weld_followers(const Generation& generation, const Model& model, const NodeSet& moving) {
  const Dependents& dependents = generation.relations->dependents;
  std::vector<FollowerNode> followers;
  if (dependents.on_sheets.empty()) return followers;
  const auto stays = [&](NodeIndex node) {
    return model.is_removed(node) || std::binary_search(moving.begin(), moving.end(), node) ||
           (generation.node_marks[node.value] & kLocked) != 0 || model.node_holds[node.value] != 0;
  };
  const auto all_end = dependents.on_sheets_by_shell.end();
  auto at = dependents.on_sheets_by_shell.begin();
  for (const ShellIndex shell : shells_touching(model, moving)) {
    at = std::lower_bound(at, all_end, shell, [&](std::uint32_t i, ShellIndex s) { return dependents.on_sheets[i].shell < s; });
    for (; at != all_end && dependents.on_sheets[*at].shell == shell; ++at) {
      const NodeOnSheet& each = dependents.on_sheets[*at];
      if (each.tied || stays(each.node)) continue;
      const auto on = spatial::ShellTree(model, {shell}).closest(model.position(each.node), each.reach);
      if (on) followers.push_back(follower_of(model, each.node, *on));
    }
    if (at == all_end) break;
  }
  std::sort(followers.begin(), followers.end(), [](const FollowerNode& a, const FollowerNode& b) { return a.node < b.node; });
  return followers;
}

}  // namespace prismesh::mesh::document

// Finds the nodes that have no weight of their own but follow others: mid-side nodes and nodes of welds. Private to mesh/document.
#pragma once

#include <array>
#include <vector>

#include "mesh/document/generation.h"
#include "mesh/model/node_set.h"
#include "mesh/shape/weights.h"

namespace prismesh::mesh::document {

/// Moves by the shares of its leaders' moves. Leaders are never followers; one that doesn't move has no effect.
struct FollowerNode {
  NodeIndex node;
  std::array<NodeIndex, 4> leader;  ///< invalid: none
  std::array<double, 4> share{};
};

/// The nodes that weights move, and the mid-side nodes that follow them.
struct WeightedNodes {
  NodeSet nodes;                      ///< weight > 0, no mid-side nodes
  std::vector<FollowerNode> middles;  ///< ascending by node: half of each end of the edge
  std::size_t reached_middles = 0;    ///< mid-side nodes among those of the weights: they need no path from the grab
};
WeightedNodes find_weighted(const Model& model, const shape::Weights& weights);

/// The nodes of welds that lie on shells with moving corners and follow these, but for those that are among `moving`, are held or belong to
/// a locked part. Both ascending. Costs the shells that touch moving nodes.
std::vector<FollowerNode> find_weld_followers(const Generation& generation, const NodeSet& moving);
/// The same where the nodes stand as in `model`, which differs from the generation's by positions alone.
std::vector<FollowerNode> find_weld_followers(const Generation& generation, const Model& model, const NodeSet& moving);

}  // namespace prismesh::mesh::document

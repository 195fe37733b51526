// Adjacency of shells: CSR node -> shells, and a sorted edge table with any number of shells at an edge. Half-edge structures can't hold
// the third sheet at a T-junction, and real shell models have many of them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/model/index.h"

namespace prismesh::mesh {

struct Model;

using EdgeIndex = Index<struct EdgeTag>;

struct Edge {
  NodeIndex low;  ///< the end with the lower index
  NodeIndex high;
};

struct Adjacency {
  // node n's shells: node_shells[node_first[n] .. node_first[n+1]), ascending
  std::vector<std::uint32_t> node_first;
  std::vector<ShellIndex> node_shells;
  // edges sorted by (low, high); node n is the low end of edges edge_first[n] .. edge_first[n+1]
  std::vector<std::uint32_t> edge_first;
  std::vector<NodeIndex> edge_high;
  // edge e's shells: edge_shells[edge_shell_first[e] .. edge_shell_first[e+1]), ascending
  std::vector<std::uint32_t> edge_shell_first;
  std::vector<ShellIndex> edge_shells;

  std::size_t edge_count() const { return edge_high.size(); }
  std::span<const ShellIndex> shells_of(NodeIndex node) const {
    return std::span(node_shells).subspan(node_first[node.value], node_first[node.value + 1] - node_first[node.value]);
  }
  std::span<const ShellIndex> shells_of(EdgeIndex edge) const {
    return std::span(edge_shells).subspan(edge_shell_first[edge.value], edge_shell_first[edge.value + 1] - edge_shell_first[edge.value]);
  }
  /// The edge between two nodes in either order; invalid if there is none.
  EdgeIndex find_edge(NodeIndex a, NodeIndex b) const;
  Edge edge(EdgeIndex edge) const;  ///< O(log nodes)
};

/// Builds the adjacency of all shells. Degenerate shells contribute no edge from a node to itself.
Adjacency build_adjacency(const Model& model);

/// Returns the adjacency of `after`, which was made from `before` (with its adjacency) by any number of edits. The result is that of
/// build_adjacency, at the cost of copying what didn't change.
Adjacency update_adjacency(const Model& before, const Model& after);

/// For each node 1 if it lies on a free edge (an edge of exactly one shell), else 0.
std::vector<std::uint8_t> free_edge_nodes(const Adjacency& adjacency, std::size_t node_count);

}  // namespace prismesh::mesh

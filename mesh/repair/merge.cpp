#include "mesh/repair/merge.h"

#include <algorithm>

namespace prismesh::mesh::repair {

namespace {

/// What the indices of a piece's new nodes and shells become.
struct NewIndices {
  std::size_t nodes_of_model, shells_of_model;
  std::size_t nodes_before, shells_before;  ///< new ones of the pieces before

  NodeIndex operator()(NodeIndex node) const {
    return node.valid() && node.value >= nodes_of_model ? NodeIndex(node.value + nodes_before) : node;
  }
  ShellIndex operator()(ShellIndex shell) const {
    return shell.valid() && shell.value >= shells_of_model ? ShellIndex(shell.value + shells_before) : shell;
  }
  ShellNodes operator()(ShellNodes nodes) const {
    for (NodeIndex& node : nodes.node) node = (*this)(node);
    return nodes;
  }
};

template <class T>
void append(std::vector<T>& all, const std::vector<T>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

void add_change(Restructuring& all, const Restructuring& piece, const NewIndices& index_of) {
  for (NewNode node : piece.new_nodes) {
    for (NodeIndex& parent : node.origin.parent) parent = index_of(parent);
    all.new_nodes.push_back(node);
  }
  for (const NewShell& shell : piece.new_shells) all.new_shells.push_back({index_of(shell.nodes), shell.parent});
  for (const auto& [shell, nodes] : piece.reshaped) all.reshaped.emplace_back(shell, index_of(nodes));
  append(all.removed_shells, piece.removed_shells);
  append(all.removed_nodes, piece.removed_nodes);
  append(all.moved, piece.moved);
}

void add_counts(Repaired& all, const Repaired& piece) {
  for (std::size_t i = 0; i < all.done.size(); ++i) all.done[i] += piece.done[i];
  all.relaxed += piece.relaxed;
  all.rounds = std::max(all.rounds, piece.rounds);
  all.bad_left += piece.bad_left;
}

/// Where each piece was stopped, if one was.
std::optional<StoppedAt> stops_of(std::span<const Repaired> pieces) {
  if (std::none_of(pieces.begin(), pieces.end(), [](const Repaired& piece) { return piece.stopped.has_value(); })) return std::nullopt;
  StoppedAt all;
  for (const Repaired& piece : pieces) all.steps.push_back(piece.stopped ? piece.stopped->steps.front() : 0);
  return all;
}

void sort(Repaired& all) {
  const auto by_first = [](const auto& a, const auto& b) { return a.first < b.first; };
  std::sort(all.change.reshaped.begin(), all.change.reshaped.end(), by_first);
  std::sort(all.change.moved.begin(), all.change.moved.end(), by_first);
  std::sort(all.change.removed_shells.begin(), all.change.removed_shells.end());
  std::sort(all.change.removed_nodes.begin(), all.change.removed_nodes.end());
  std::sort(all.unrepaired.begin(), all.unrepaired.end(), [](const Unrepaired& a, const Unrepaired& b) { return a.shell < b.shell; });
  // New nodes have no index here: they stay in the order of the pieces.
  std::stable_sort(all.clusters_left.begin(), all.clusters_left.end(),
                   [](const ClusterLeft& a, const ClusterLeft& b) { return a.node < b.node; });
}

}  // namespace

Repaired merge(const Model& model, std::span<const Repaired> pieces) {
  Repaired all;
  for (const Repaired& piece : pieces) {
    const NewIndices index_of{model.node_count(), model.shell_count(), all.change.new_nodes.size(), all.change.new_shells.size()};
    add_change(all.change, piece.change, index_of);
    add_counts(all, piece);
    append(all.clusters_left, piece.clusters_left);
    for (const auto& [a, b] : piece.triangle_pairs) all.triangle_pairs.emplace_back(index_of(a), index_of(b));
    for (const Unrepaired& left : piece.unrepaired) all.unrepaired.push_back({index_of(left.shell), left.why});
  }
  sort(all);
  all.stopped = stops_of(pieces);
  return all;
}

}  // namespace prismesh::mesh::repair

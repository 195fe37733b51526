#include "mesh/repair/compose.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "mesh/repair/heaviest.h"

namespace prismesh::mesh::repair {

namespace {

class Composer {
 public:
  Composer(const Model& model, const Restructuring& first, const Restructuring& second)
      : model_(model), first_(first), second_(second), nodes_(first.new_nodes), shells_(first.new_shells) {
    nodes_.insert(nodes_.end(), second.new_nodes.begin(), second.new_nodes.end());
    shells_.insert(shells_.end(), second.new_shells.begin(), second.new_shells.end());
    // A new shell of the second change may come from one of the first: all come from the model's.
    for (std::size_t i = first.new_shells.size(); i < shells_.size(); ++i)
      if (is_new(shells_[i].parent)) shells_[i].parent = shells_[number_of(shells_[i].parent)].parent;
  }

  Composition compose() {
    gather();
    number_nodes();
    number_shells();
    write_nodes();
    write_shells();
    return std::move(composition_);
  }

 private:
  bool is_new(NodeIndex node) const { return node.value >= model_.node_count(); }
  bool is_new(ShellIndex shell) const { return shell.value >= model_.shell_count(); }
  std::size_t number_of(NodeIndex node) const { return node.value - model_.node_count(); }
  std::size_t number_of(ShellIndex shell) const { return shell.value - model_.shell_count(); }

  /// What each change did to entities of the model and to new ones; the second has the last word.
  void gather() {
    for (const Restructuring* each : {&first_, &second_}) {
      removed_nodes_.insert(each->removed_nodes.begin(), each->removed_nodes.end());
      removed_shells_.insert(each->removed_shells.begin(), each->removed_shells.end());
      for (const auto& [node, position] : each->moved) {
        if (is_new(node))
          nodes_[number_of(node)].position = position;
        else
          moved_[node] = position;
      }
      for (const auto& [shell, corners] : each->reshaped) {
        if (is_new(shell))
          shells_[number_of(shell)].nodes = corners;
        else
          reshaped_[shell] = corners;
      }
    }
  }

  void number_nodes() {
    std::size_t next = model_.node_count();
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const bool is_gone = removed_nodes_.contains(NodeIndex(model_.node_count() + i));
      composition_.new_node_index.push_back(is_gone ? NodeIndex() : NodeIndex(next++));
    }
  }

  void number_shells() {
    std::size_t next = model_.shell_count();
    for (std::size_t i = 0; i < shells_.size(); ++i) {
      ShellIndex index;
      if (!removed_shells_.contains(ShellIndex(model_.shell_count() + i)))
        index = removed_shells_.erase(shells_[i].parent) > 0 ? shells_[i].parent : ShellIndex(next++);
      composition_.new_shell_index.push_back(index);
    }
  }

  NodeIndex index_of(NodeIndex node) const { return is_new(node) ? composition_.new_node_index[number_of(node)] : node; }
  ShellNodes index_of(ShellNodes corners) const {
    for (NodeIndex& node : corners.node) node = index_of(node);
    return corners;
  }

  void add_parents(const NodeOrigin& origin, double weight, std::map<NodeIndex, double>& weights) const {
    for (std::size_t p = 0; p < static_cast<std::size_t>(origin.count()); ++p) {
      const NodeIndex parent = origin.parent[p];
      if (index_of(parent).valid())
        weights[index_of(parent)] += weight * origin.weight[p];
      else
        add_parents(nodes_[number_of(parent)].origin, weight * origin.weight[p], weights);
    }
  }

  void write_nodes() {
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      if (!composition_.new_node_index[i].valid()) continue;
      std::map<NodeIndex, double> weights;
      add_parents(nodes_[i].origin, 1, weights);
      NewNode node{nodes_[i].position, {}};
      std::size_t p = 0;
      for (const auto& [parent, weight] : heaviest_four(weights)) {
        node.origin.parent[p] = parent;
        node.origin.weight[p++] = weight;
      }
      composition_.change.new_nodes.push_back(node);
    }
    for (const auto& [node, position] : moved_)
      if (!removed_nodes_.contains(node) && position != model_.position(node)) composition_.change.moved.emplace_back(node, position);
    for (const NodeIndex node : removed_nodes_)
      if (!is_new(node)) composition_.change.removed_nodes.push_back(node);
  }

  void write_shells() {
    Restructuring& change = composition_.change;
    for (std::size_t i = 0; i < shells_.size(); ++i) {
      const ShellIndex index = composition_.new_shell_index[i];
      if (!index.valid()) continue;
      if (is_new(index))
        change.new_shells.push_back({index_of(shells_[i].nodes), shells_[i].parent});
      else
        reshaped_[index] = shells_[i].nodes;
    }
    for (const auto& [shell, corners] : reshaped_)
      if (!removed_shells_.contains(shell) && index_of(corners) != model_.shell(shell))
        change.reshaped.emplace_back(shell, index_of(corners));
    for (const ShellIndex shell : removed_shells_)
      if (!is_new(shell)) change.removed_shells.push_back(shell);
  }

  const Model& model_;
  const Restructuring &first_, &second_;
  std::vector<NewNode> nodes_;    ///< of both
  std::vector<NewShell> shells_;  ///< of both
  std::map<NodeIndex, Vec3> moved_;
  std::map<ShellIndex, ShellNodes> reshaped_;
  std::set<NodeIndex> removed_nodes_;
  std::set<ShellIndex> removed_shells_;
  Composition composition_;
};

}  // namespace

Composition compose(const Model& model, const Restructuring& first, const Restructuring& second) {
  return Composer(model, first, second).compose();
}

}  // namespace prismesh::mesh::repair

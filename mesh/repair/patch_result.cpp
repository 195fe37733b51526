// The result of a patch: as changes of its model, and as a small model.
#include <map>

#include "mesh/model/adjacency.h"
#include "mesh/repair/heaviest.h"
#include "mesh/repair/patch.h"

namespace prismesh::mesh::repair {

namespace {

/// Adds the weights of the nodes that a new node comes from, followed back over removed new nodes.
void gather_origin(const Patch& patch, LocalNode node, double weight, std::map<LocalNode, double>& weights) {
  const PatchNode& from = patch.node(node);
  for (std::size_t i = 0; i < 4 && from.parent[i].valid(); ++i) {
    const LocalNode parent = from.parent[i];
    const bool is_gone = !patch.node(parent).is_alive && !patch.node(parent).model.valid();
    if (is_gone)
      gather_origin(patch, parent, weight * from.weight[i], weights);
    else
      weights[parent] += weight * from.weight[i];
  }
}

NodeOrigin origin_in_model(const Patch& patch, LocalNode node, const std::vector<NodeIndex>& index_of) {
  std::map<LocalNode, double> weights;
  gather_origin(patch, node, 1, weights);
  NodeOrigin origin;
  std::size_t p = 0;
  for (const auto& [parent, share] : heaviest_four(weights)) {
    origin.parent[p] = index_of[parent.value];
    origin.weight[p++] = share;
  }
  return origin;
}

ShellNodes nodes_in_model(const Corners& corners, const std::vector<NodeIndex>& index_of) {
  ShellNodes nodes;
  for (std::size_t c = 0; c < 4; ++c) nodes.node[c] = index_of[corners[c].value];
  return nodes;
}

}  // namespace

PatchResult Patch::result() const {
  PatchResult result;
  result.shell_index.resize(shells_.size());
  result.node_index.resize(nodes_.size());
  auto& [change, shell_index, index_of] = result;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const PatchNode& node = nodes_[i];
    if (node.model.valid()) {
      index_of[i] = node.model;
      if (!node.is_alive)
        change.removed_nodes.push_back(node.model);
      else if (node.position != model_->position(node.model) && node.position.allFinite())
        change.moved.emplace_back(node.model, node.position);
    } else if (node.is_alive) {
      index_of[i] = NodeIndex(model_->node_count() + change.new_nodes.size());
      change.new_nodes.push_back({node.position, origin_in_model(*this, LocalNode(i), index_of)});
    }
  }
  // A removed shell's card goes to the first new shell that came from it.
  std::map<ShellIndex, LocalShell> replacements;
  for (std::size_t i = 0; i < model_shells_.size(); ++i)
    if (!shells_[i].is_alive) replacements[model_shells_[i]] = LocalShell();
  for (std::size_t i = model_shells_.size(); i < shells_.size(); ++i) {
    const auto gone = shells_[i].is_alive ? replacements.find(shells_[i].parent) : replacements.end();
    if (gone != replacements.end() && !gone->second.valid()) gone->second = LocalShell(i);
  }
  for (std::size_t i = 0; i < model_shells_.size(); ++i) {
    const ShellIndex index = model_shells_[i];
    const LocalShell lives_as = shells_[i].is_alive ? LocalShell(i) : replacements.at(index);
    if (!lives_as.valid()) {
      change.removed_shells.push_back(index);
      continue;
    }
    shell_index[lives_as.value] = index;
    const ShellNodes nodes = nodes_in_model(shell(lives_as).corners, index_of);
    if (nodes != model_->shell(index)) change.reshaped.emplace_back(index, nodes);
  }
  for (std::size_t i = model_shells_.size(); i < shells_.size(); ++i) {
    if (!shells_[i].is_alive) continue;
    const auto gone = replacements.find(shells_[i].parent);
    if (gone != replacements.end() && gone->second == LocalShell(i)) continue;
    shell_index[i] = ShellIndex(model_->shell_count() + change.new_shells.size());
    change.new_shells.push_back({nodes_in_model(shells_[i].corners, index_of), shells_[i].parent});
  }
  return result;
}

Model Patch::as_model(std::vector<LocalShell>& shells_of_model) const {
  Model small;
  small.positions.resize(nodes_.size(), Vec3::Zero());
  small.node_ids.resize(nodes_.size());
  small.node_holds.resize(nodes_.size());
  // No ids: these nodes are not those of the surface's model, whatever their indices.
  for (std::size_t i = 0; i < nodes_.size(); ++i) small.positions.set(i, nodes_[i].position);
  shells_of_model.clear();
  for (std::size_t i = 0; i < shells_.size(); ++i)
    if (shells_[i].is_alive) shells_of_model.push_back(LocalShell(i));
  const std::size_t count = shells_of_model.size();
  small.shell_ids.resize(count);
  small.shell_nodes.resize(count);
  small.shell_parts.resize(count);
  small.shell_thickness.resize(count);
  std::vector<NodeIndex> index_of(nodes_.size());
  for (std::size_t i = 0; i < nodes_.size(); ++i) index_of[i] = NodeIndex(i);
  for (std::size_t i = 0; i < count; ++i) {
    const PatchShell& from = shell(shells_of_model[i]);
    small.shell_ids.set(i, static_cast<std::int64_t>(i) + 1);
    small.shell_nodes.set(i, nodes_in_model(from.corners, index_of));
    small.shell_parts.set(i, from.part);
    small.shell_thickness.set(i, from.properties.thickness);
  }
  small.midside = std::make_shared<const std::vector<MidsideNodes>>();
  small.parts = model_->parts;
  small.adjacency = std::make_shared<const Adjacency>(build_adjacency(small));
  return small;
}

}  // namespace prismesh::mesh::repair

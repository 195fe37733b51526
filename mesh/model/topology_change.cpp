#include "mesh/model/topology_change.h"

#include <algorithm>
#include <memory>
#include <utility>

namespace prismesh::mesh {

namespace {

/// The model's topology change for writing: copied first if another model shares it.
TopologyChange& own_topology_change(Model& model) {
  if (!model.topology_change || model.topology_change.use_count() > 1) {
    auto topology_change =
        model.topology_change ? std::make_shared<TopologyChange>(*model.topology_change) : std::make_shared<TopologyChange>();
    if (!model.topology_change) {
      topology_change->deck_nodes = model.node_count();
      topology_change->deck_shells = model.shell_count();
      for (std::size_t c = 0; c < model.elements.size(); ++c)
        if (model.elements[c]) topology_change->deck_elements[c] = model.elements[c]->size();
      topology_change->deck_parts = model.parts ? model.parts->size() : 0;
    }
    model.topology_change = std::move(topology_change);
  }
  // the only owner, and the object wasn't created as a constant
  return const_cast<TopologyChange&>(*model.topology_change);
}

template <class T>
void push_back(ChunkedArray<T>& array, const T& value) {
  array.resize(array.size() + 1, value);
}

constexpr ShellNodes kNoNodes{};

/// Those of the list that are in one of the models but not in the other.
template <class IndexType>
std::vector<IndexType> sorted_unique(std::vector<IndexType> list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
  return list;
}

template <class IndexType>
std::vector<IndexType> added_between(std::size_t before, std::size_t after, const Model& model) {
  std::vector<IndexType> added;
  for (std::size_t i = before; i < after; ++i)
    if (!model.is_removed(IndexType(i))) added.push_back(IndexType(i));
  return added;
}

/// Those removed since `before` that existed there.
template <class IndexType>
std::vector<IndexType> removed_since(std::vector<IndexType> removed, std::size_t count_before, const Model& before) {
  std::erase_if(removed, [&](IndexType i) { return i.value >= count_before || before.is_removed(i); });
  return sorted_unique(std::move(removed));
}

}  // namespace

NodeOrigin edge_origin(NodeIndex a, NodeIndex b, double weight_of_b) {
  return {{a, b, NodeIndex(), NodeIndex()}, {1 - weight_of_b, weight_of_b, 0, 0}};
}

NodeOrigin centre_origin(const ShellNodes& shell) {
  NodeOrigin origin;
  const int corners = shell.corners();
  for (int i = 0; i < corners; ++i) {
    const auto at = static_cast<std::size_t>(i);
    origin.parent[at] = shell.node[at];
    origin.weight[at] = 1.0 / corners;
  }
  return origin;
}

NodeIndex add_node(Model& model, std::int64_t id, const Vec3& position, const NodeOrigin& origin) {
  TopologyChange& topology_change = own_topology_change(model);
  const NodeIndex node(model.node_count());
  push_back(topology_change.node_origins, origin);
  push_back(model.node_ids, id);
  push_back(model.positions, position);
  push_back(model.node_holds, std::uint8_t{0});
  IdIndex::add(model.node_index, id, node.value);
  model.adjacency.reset();
  return node;
}

NodeIndex add_placed_node(Model& model, std::int64_t id, const Vec3& position, const NodeOrigin& origin, std::uint32_t joins) {
  const NodeIndex node = add_node(model, id, position, origin);
  own_topology_change(model).placed_nodes.push_back({node, joins});
  return node;
}

std::uint32_t add_element(Model& model, ElementClass element_class, std::int64_t id, PartIndex part, std::span<const NodeIndex> nodes,
                          std::uint32_t example) {
  TopologyChange& topology_change = own_topology_change(model);
  const auto c = static_cast<std::size_t>(element_class);
  std::shared_ptr<const ElementBlock>& shared = model.elements[c];
  // The deck's own block may have been created as a constant.
  if (!shared || shared.use_count() > 1 || topology_change.element_examples[c].empty())
    shared = shared ? std::make_shared<ElementBlock>(*shared) : std::make_shared<ElementBlock>();
  // the only owner, and the object wasn't created as a constant
  auto& block = const_cast<ElementBlock&>(*shared);
  block.id.push_back(id);
  block.part.push_back(part);
  block.nodes.insert(block.nodes.end(), nodes.begin(), nodes.end());
  block.first_node.push_back(static_cast<std::uint32_t>(block.nodes.size()));
  topology_change.element_examples[c].push_back(example);
  return static_cast<std::uint32_t>(block.size() - 1);
}

PartIndex add_part(Model& model, Part part, AddedPart added) {
  own_topology_change(model).added_parts.push_back(std::move(added));
  auto parts = model.parts ? std::make_shared<std::vector<Part>>(*model.parts) : std::make_shared<std::vector<Part>>();
  parts->push_back(std::move(part));
  const PartIndex index(parts->size() - 1);
  model.parts = std::move(parts);
  return index;
}

ShellIndex add_shell(Model& model, std::int64_t id, const ShellNodes& nodes, ShellIndex parent) {
  TopologyChange& topology_change = own_topology_change(model);
  const ShellIndex shell(model.shell_count());
  push_back(topology_change.shell_parents, parent);
  push_back(model.shell_ids, id);
  push_back(model.shell_nodes, nodes);
  push_back(model.shell_parts, PartIndex(model.shell_parts[parent.value]));
  push_back(model.shell_thickness, float{model.shell_thickness[parent.value]});
  IdIndex::add(model.shell_index, id, shell.value);
  model.adjacency.reset();
  return shell;
}

void set_shell_nodes(Model& model, ShellIndex shell, const ShellNodes& nodes) {
  if (model.shell(shell) == nodes) return;
  TopologyChange& topology_change = own_topology_change(model);
  // an added shell is written as a whole anyway
  if (shell.value < topology_change.deck_shells) topology_change.reshaped_shells.push_back(shell);
  model.shell_nodes.set(shell.value, nodes);
  model.adjacency.reset();
}

void remove_shell(Model& model, ShellIndex shell) {
  own_topology_change(model).removed_shells.push_back(shell);
  model.shell_nodes.set(shell.value, kNoNodes);
  IdIndex::remove(model.shell_index, model.shell_ids[shell.value]);
  model.adjacency.reset();
}

void remove_node(Model& model, NodeIndex node) {
  own_topology_change(model).removed_nodes.push_back(node);
  model.node_holds.set(node.value, static_cast<std::uint8_t>(model.node_holds[node.value] | kRemoved));
  IdIndex::remove(model.node_index, model.node_ids[node.value]);
  model.adjacency.reset();
}

std::size_t live_nodes(const Model& model) {
  return model.node_count() - (model.topology_change ? model.topology_change->removed_nodes.size() : 0);
}
std::size_t live_shells(const Model& model) {
  return model.shell_count() - (model.topology_change ? model.topology_change->removed_shells.size() : 0);
}

bool is_added(const Model& model, NodeIndex node) { return model.topology_change && node.value >= model.topology_change->deck_nodes; }
bool is_added(const Model& model, ShellIndex shell) { return model.topology_change && shell.value >= model.topology_change->deck_shells; }

const PlacedNode* placed_node(const Model& model, NodeIndex node) {
  if (!is_added(model, node)) return nullptr;
  const std::vector<PlacedNode>& placed = model.topology_change->placed_nodes;
  const auto at = std::lower_bound(placed.begin(), placed.end(), node, [](const PlacedNode& each, NodeIndex n) { return each.node < n; });
  return at != placed.end() && at->node == node ? &*at : nullptr;
}

const NodeOrigin& origin_of(const Model& model, NodeIndex node) {
  return model.topology_change->node_origins[node.value - model.topology_change->deck_nodes];
}

ShellIndex deck_ancestor(const Model& model, ShellIndex shell) {
  // ends, since a parent is older than its child
  while (is_added(model, shell)) shell = model.topology_change->shell_parents[shell.value - model.topology_change->deck_shells];
  return shell;
}

Changes changes_between(const Model& before, const Model& after) {
  Changes changes;
  if (!after.topology_change || after.topology_change == before.topology_change) return changes;
  changes.added_nodes = added_between<NodeIndex>(before.node_count(), after.node_count(), after);
  changes.added_shells = added_between<ShellIndex>(before.shell_count(), after.shell_count(), after);
  changes.removed_nodes = removed_since(after.topology_change->removed_nodes, before.node_count(), before);
  changes.removed_shells = removed_since(after.topology_change->removed_shells, before.shell_count(), before);
  // shells that were added before `before` may have got other nodes since without being listed
  std::vector<ShellIndex> reshaped = after.topology_change->reshaped_shells;
  for (std::size_t s = after.topology_change->deck_shells; s < before.shell_count(); ++s) reshaped.push_back(ShellIndex(s));
  std::erase_if(reshaped, [&](ShellIndex s) {
    return s.value >= before.shell_count() || before.is_removed(s) || after.is_removed(s) || before.shell(s) == after.shell(s);
  });
  changes.reshaped_shells = sorted_unique(std::move(reshaped));
  for (std::size_t c = 0; c < after.elements.size(); ++c) {
    const std::size_t from = before.elements[c] ? before.elements[c]->size() : 0, to = after.elements[c] ? after.elements[c]->size() : 0;
    for (std::size_t e = from; e < to; ++e) changes.added_elements[c].push_back(static_cast<std::uint32_t>(e));
  }
  for (std::size_t p = before.parts ? before.parts->size() : 0; after.parts && p < after.parts->size(); ++p)
    changes.added_parts.emplace_back(p);
  return changes;
}

}  // namespace prismesh::mesh

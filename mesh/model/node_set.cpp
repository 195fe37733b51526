#include "mesh/model/node_set.h"

#include <algorithm>

#include "mesh/model/adjacency.h"
#include "mesh/model/model.h"

namespace prismesh::mesh {

namespace {

template <class Index>
void sort_unique(std::vector<Index>& set) {
  std::sort(set.begin(), set.end());
  set.erase(std::unique(set.begin(), set.end()), set.end());
}

/// Ascending indices of the marked entries.
template <class Index>
std::vector<Index> marked(const std::vector<std::uint8_t>& marks, std::size_t expected) {
  std::vector<Index> set;
  set.reserve(expected);
  for (std::size_t i = 0; i < marks.size(); ++i)
    if (marks[i] != 0) set.push_back(Index(i));
  return set;
}

/// Above this share of all entries, marks in an array of the model's size are faster than sorting a list.
bool is_large(std::size_t gathered, std::size_t all) { return gathered > all / 16; }

/// The mid-side nodes of a shell, or nullptr.
const MidsideNodes* midside_of(const Model& model, ShellIndex shell) {
  if (!model.midside) return nullptr;
  const auto& all = *model.midside;
  const auto found = std::lower_bound(all.begin(), all.end(), shell, [](const MidsideNodes& m, ShellIndex s) { return m.shell < s; });
  return found != all.end() && found->shell == shell ? &*found : nullptr;
}

template <class Body>
void for_each_node(const Model& model, ShellIndex shell, const Body& body) {
  const ShellNodes& nodes = model.shell(shell);
  for (int i = 0; i < nodes.corners(); ++i) body(nodes.node[i]);
  if (const MidsideNodes* midside = midside_of(model, shell))
    for (const NodeIndex node : midside->node)
      if (node.valid()) body(node);
}

}  // namespace

ShellSet shells_touching(const Model& model, const NodeSet& nodes) {
  const Adjacency& adjacency = *model.adjacency;
  std::size_t uses = 0;
  for (const NodeIndex node : nodes) uses += adjacency.shells_of(node).size();
  if (is_large(uses, model.shell_count())) {
    std::vector<std::uint8_t> marks(model.shell_count(), 0);
    for (const NodeIndex node : nodes)
      for (const ShellIndex shell : adjacency.shells_of(node)) marks[shell.value] = 1;
    return marked<ShellIndex>(marks, uses);
  }
  ShellSet shells;
  shells.reserve(uses);
  for (const NodeIndex node : nodes) {
    const auto around = adjacency.shells_of(node);
    shells.insert(shells.end(), around.begin(), around.end());
  }
  sort_unique(shells);
  return shells;
}

ShellSet shells_inside(const Model& model, const NodeSet& nodes) {
  ShellSet shells = shells_touching(model, nodes);
  const auto keep = [&](auto&& contains) {
    std::erase_if(shells, [&](ShellIndex shell) {
      const ShellNodes& corners = model.shell(shell);
      return !std::all_of(corners.node.begin(), corners.node.begin() + corners.corners(), contains);
    });
  };
  if (is_large(nodes.size(), model.node_count())) {
    std::vector<std::uint8_t> marks(model.node_count(), 0);
    for (const NodeIndex node : nodes) marks[node.value] = 1;
    keep([&](NodeIndex node) { return marks[node.value] != 0; });
  } else {
    keep([&](NodeIndex node) { return std::binary_search(nodes.begin(), nodes.end(), node); });
  }
  return shells;
}

NodeSet nodes_of(const Model& model, const ShellSet& shells) {
  if (is_large(4 * shells.size(), model.node_count())) {
    std::vector<std::uint8_t> marks(model.node_count(), 0);
    for (const ShellIndex shell : shells) for_each_node(model, shell, [&](NodeIndex node) { marks[node.value] = 1; });
    return marked<NodeIndex>(marks, shells.size());
  }
  NodeSet nodes;
  nodes.reserve(4 * shells.size());
  for (const ShellIndex shell : shells) for_each_node(model, shell, [&](NodeIndex node) { nodes.push_back(node); });
  sort_unique(nodes);
  return nodes;
}

}  // namespace prismesh::mesh

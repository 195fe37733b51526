#include "mesh/document/find_dependents.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "mesh/connections/nodes_on_sheets.h"
#include "mesh/document/node_cards.h"
#include "mesh/model/adjacency.h"

namespace prismesh::mesh::document {

Dependents find_dependents(const deck::Deck& deck, const Model& model, std::span<const ElementUse> uses) {
  Dependents dependents;
  NodeCards cards;
  if (deck.references) cards = find_node_cards(*deck.references, model);
  dependents.joining_cards = std::move(cards.joining);
  for (std::size_t j = 0; j < dependents.joining_cards.size(); ++j)
    for (const NodeIndex node : dependents.joining_cards[j].nodes) dependents.joined_nodes.push_back({node, static_cast<std::uint32_t>(j)});
  std::sort(dependents.joined_nodes.begin(), dependents.joined_nodes.end());

  std::vector<NodeOnSheet> candidates = connections::find_weld_nodes(model, uses);
  for (const auto& [node, referrer] : cards.tied) {
    if (model.adjacency->shells_of(node).empty()) continue;
    NodeOnSheet tied;
    tied.node = node;
    tied.tied = true;
    tied.of = referrer;
    candidates.push_back(tied);
  }
  const auto by_node = [](const NodeOnSheet& a, const NodeOnSheet& b) { return a.node < b.node; };
  std::stable_sort(candidates.begin(), candidates.end(), by_node);
  candidates.erase(std::unique(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) { return a.node == b.node; }),
                   candidates.end());
  add_on_sheets(connections::find_sheets(model, std::move(candidates)), dependents);
  return dependents;
}

void add_on_sheets(std::vector<NodeOnSheet> more, Dependents& dependents) {
  std::vector<NodeOnSheet>& all = dependents.on_sheets;
  const auto by_node = [](const NodeOnSheet& a, const NodeOnSheet& b) { return a.node < b.node; };
  const auto old = static_cast<std::ptrdiff_t>(all.size());
  all.insert(all.end(), more.begin(), more.end());
  std::inplace_merge(all.begin(), all.begin() + old, all.end(), by_node);
  all.erase(std::unique(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.node == b.node; }), all.end());
  dependents.on_sheets_by_shell.resize(dependents.on_sheets.size());
  std::iota(dependents.on_sheets_by_shell.begin(), dependents.on_sheets_by_shell.end(), 0u);
  std::stable_sort(dependents.on_sheets_by_shell.begin(), dependents.on_sheets_by_shell.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return dependents.on_sheets[a].shell < dependents.on_sheets[b].shell; });
}

}  // namespace prismesh::mesh::document

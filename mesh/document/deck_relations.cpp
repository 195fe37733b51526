#include "mesh/document/deck_relations.h"

#include <algorithm>

namespace prismesh::mesh::document {

namespace {

template <class Use>
std::span<const Use> of_node(const std::vector<Use>& uses, NodeIndex node) {
  const auto begin = std::lower_bound(uses.begin(), uses.end(), node, [](const Use& use, NodeIndex n) { return use.node < n; });
  auto end = begin;
  while (end != uses.end() && end->node == node) ++end;
  return {begin, end};
}

}  // namespace

std::span<const ElementUse> uses_at(const DeckRelations& relations, NodeIndex node) { return of_node(relations.element_uses, node); }

std::span<const HiddenUse> hidden_at(const DeckRelations& relations, NodeIndex node) { return of_node(relations.hidden_uses, node); }

std::span<const JoinedNode> cards_at(const DeckRelations& relations, NodeIndex node) {
  return of_node(relations.dependents.joined_nodes, node);
}

bool is_joined(const DeckRelations& relations, NodeIndex node) { return !cards_at(relations, node).empty(); }

}  // namespace prismesh::mesh::document

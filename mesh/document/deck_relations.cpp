#include "mesh/document/deck_relations.h"

#include <algorithm>

namespace prismesh::mesh::document {

std::span<const ElementUse> uses_at(const DeckRelations& relations, NodeIndex node) {
  const auto& uses = relations.element_uses;
  const auto begin = std::lower_bound(uses.begin(), uses.end(), node, [](const ElementUse& use, NodeIndex n) { return use.node < n; });
  auto end = begin;
  while (end != uses.end() && end->node == node) ++end;
  return {begin, end};
}

bool is_joined(const DeckRelations& relations, NodeIndex node) {
  const auto& joined = relations.dependents.joined_nodes;
  const auto at = std::lower_bound(joined.begin(), joined.end(), node, [](const JoinedNode& each, NodeIndex n) { return each.node < n; });
  return at != joined.end() && at->node == node;
}

}  // namespace prismesh::mesh::document

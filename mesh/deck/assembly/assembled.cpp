#include "mesh/deck/assembly/assembled.h"

namespace prismesh::mesh::deck {

void hide(const HiddenElements::Card& card, std::span<const NodeIndex> nodes, HiddenElements& hidden) {
  hidden.cards.push_back(card);
  for (const NodeIndex node : nodes)
    if (node.valid()) hidden.nodes.push_back(node);
  hidden.first_node.push_back(static_cast<std::uint32_t>(hidden.nodes.size()));
}

}  // namespace prismesh::mesh::deck

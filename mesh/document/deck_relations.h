// What edits need of a deck besides its shells: names for expressions, the elements at nodes, and what depends on nodes. Found when the
// deck is opened, shared by all generations.
#pragma once

#include <compare>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "mesh/connections/node_on_sheet.h"
#include "mesh/deck/data/deck.h"
#include "mesh/document/dependents.h"
#include "mesh/select/names.h"

namespace prismesh::mesh::document {

using connections::ElementUse;

/// An element that the model leaves out at a node.
struct HiddenUse {
  NodeIndex node;
  std::uint32_t element = 0;  ///< in Deck::hidden
  auto operator<=>(const HiddenUse&) const = default;
};

struct DeckRelations {
  std::shared_ptr<const deck::Deck> deck;  ///< keeps what `names` points into
  select::Names names;
  std::vector<ElementUse> element_uses;  ///< ascending
  std::vector<HiddenUse> hidden_uses;    ///< ascending
  Dependents dependents;
};

/// The elements other than shells at a node. Costs a binary search.
std::span<const ElementUse> uses_at(const DeckRelations& relations, NodeIndex node);
/// The elements that the model leaves out at a node. Costs a binary search.
std::span<const HiddenUse> hidden_at(const DeckRelations& relations, NodeIndex node);
/// The cards that join the node to others. Costs a binary search.
std::span<const JoinedNode> cards_at(const DeckRelations& relations, NodeIndex node);
/// Whether a card joins the node to others. Costs a binary search.
bool is_joined(const DeckRelations& relations, NodeIndex node);

}  // namespace prismesh::mesh::document

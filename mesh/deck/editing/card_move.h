// Converts a node's move to the coordinates of its card.
#pragma once

#include <optional>

#include "mesh/deck/data/deck.h"
#include "mesh/deck/writing/card_writer.h"

namespace prismesh::mesh::deck {

/// Where a node is and where it goes.
struct NodeMove {
  Vec3 from, to;
};

/// Converts a move of the node whose card is at `offset` from the basic system to the coordinates that the card gives. Coordinates that
/// differ by rounding only are made equal. nullopt: the card's frame can't be inverted, or a parameter gives its coordinates.
std::optional<NodeMove> move_in_card(const Deck& deck, const CardWriter& writer, const CardRun& run, std::size_t offset,
                                     const NodeMove& move);

}  // namespace prismesh::mesh::deck

// A node's move as its card has to tell it. Private to mesh/deck.
#pragma once

#include <optional>

#include "mesh/deck/data/deck.h"
#include "mesh/deck/writing/card_writer.h"

namespace prismesh::mesh::deck {

/// Where a node's card should put it, and where it puts it now, both as the card gives coordinates.
struct CardMove {
  Vec3 from, to;
};

/// The move of the node whose card is at `offset`, given in the basic system. nullopt: its frame can't be inverted, or a parameter gives
/// its coordinates.
std::optional<CardMove> in_card(const Deck& deck, const CardWriter& writer, const CardRun& run, std::size_t offset, const Vec3& from,
                                const Vec3& to);

}  // namespace prismesh::mesh::deck

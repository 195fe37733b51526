// From cards by id to the model by index.
#pragma once

#include <span>

#include "mesh/deck/assembly/piece_cards.h"
#include "mesh/deck/assembly/warnings.h"
#include "mesh/deck/data/deck.h"

namespace prismesh::mesh::deck {

/// Puts the model together, positions in the basic system (the deck's frames must be there), and fills the deck's runs, lines,
/// element_cards and element_kinds. `cards` are emptied. Of equal ids the first counts; elements with nodes that nobody defines are left
/// out; both are warned of. The adjacency isn't built.
Model assemble(std::span<PieceCards> cards, std::vector<Part> parts, Deck& deck, Warnings& warnings);

}  // namespace prismesh::mesh::deck

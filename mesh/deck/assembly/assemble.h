// Makes the model, by index, from cards, by id.
#pragma once

#include <span>

#include "mesh/deck/assembly/piece_cards.h"
#include "mesh/deck/assembly/warnings.h"
#include "mesh/deck/data/deck.h"

namespace prismesh::mesh::deck {

/// Puts nodes, parts, shells and other elements together, in this order. `cards`: the pieces in the deck's order; emptied. `parts`: the
/// defined ones, ascending by id. The deck's frames must be there; its runs, card offsets, counts, held files and left-out elements are
/// filled. Returns the model in the basic system, without adjacency. Of equal ids of one numbering the first counts; elements with nodes
/// that nobody defines are left out. Warns of both. Where such an element may need a node whose card can't be read, that card becomes its
/// piece's error.
Model assemble(std::span<PieceCards> cards, std::vector<Part> parts, Deck& deck, Warnings& warnings);

}  // namespace prismesh::mesh::deck

// From cards by id to the model by index.
#pragma once

#include <span>

#include "mesh/deck/deck.h"
#include "mesh/deck/lsdyna/mesh_cards.h"
#include "mesh/deck/lsdyna/warnings.h"

namespace prismesh::mesh::deck::lsdyna {

/// Puts the model together and fills the deck's node_runs, node_line and element_cards. `cards[i]` belongs to `pieces[i]`
/// and is emptied. Of equal ids the first counts; elements with nodes that nobody defines are left out; both are warned
/// of. The adjacency isn't built.
Model assemble(std::span<const Piece> pieces, std::span<PieceCards> cards, std::vector<Part> parts, Deck& deck, Warnings& warnings);

}  // namespace prismesh::mesh::deck::lsdyna

// Makes parts: element sets that a section names. *ELEMENT, *ELSET and sets of sets put elements into sets.
#pragma once

#include <span>
#include <vector>

#include "mesh/deck/abaqus/outline.h"
#include "mesh/deck/assembly/piece_cards.h"

namespace prismesh::mesh::deck::abaqus {

/// Replaces the groups that the elements of `cards` have as parts (read_piece) by parts. The parts of sections come first, numbered from 1
/// in the sections' order; then, for elements without a section, an undefined part for each set that *ELEMENT names. `cards[i]` belongs to
/// `outline.pieces[i]`.
std::vector<Part> make_parts(const DeckOutline& outline, std::span<PieceCards> cards, Warnings& warnings);

}  // namespace prismesh::mesh::deck::abaqus

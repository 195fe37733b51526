// Parts: element sets that a section names. Which element is in which set may be said by its own keyword, by *ELSET, and by sets of sets.
#pragma once

#include <span>
#include <vector>

#include "mesh/deck/abaqus/walk.h"
#include "mesh/deck/assembly/piece_cards.h"

namespace prismesh::mesh::deck::abaqus {

/// Turns the groups that the elements of `cards` have as parts (see read_piece) into parts: those of the sections, numbered from 1 in their
/// order, then for elements without a section those of the set that their *ELEMENT names, not defined. `cards[i]` is of
/// `walk.pieces[i]`.
std::vector<Part> make_parts(const Walk& walk, std::span<PieceCards> cards, Warnings& warnings);

}  // namespace prismesh::mesh::deck::abaqus

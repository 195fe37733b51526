// Reads the nodes and elements of a piece. This part of reading has to be fast. Runs on any thread.
#pragma once

#include "mesh/deck/abaqus/outline.h"
#include "mesh/deck/assembly/piece_cards.h"

namespace prismesh::mesh::deck::abaqus {

/// CardRun::style, as bits. Of shells: the number of corners, and whether there are mid-side nodes. Of nodes and shells: whether the ids on
/// the card aren't the model's, or the card stands for several places.
inline constexpr std::uint16_t kStyleCorners = 7;
inline constexpr std::uint16_t kStyleMidside = 8;
inline constexpr std::uint16_t kStyleShifted = 16;

/// Ids are as the cards have them. Runs have indices into DeckOutline::frames, elements the index of their group plus one as part.
/// Elements that name nodes of instances are noted as "element-between-instances" and left out.
PieceCards read_piece(const DeckOutline& outline, const Piece& piece);

}  // namespace prismesh::mesh::deck::abaqus

// The fast pass: nodes and elements of one piece.
#pragma once

#include "mesh/deck/abaqus/walk.h"
#include "mesh/deck/assembly/piece_cards.h"

namespace prismesh::mesh::deck::abaqus {

/// CardRun::style of shells: how many corners, and whether nodes stand mid-side; of both, whether the ids on the card
/// aren't the model's, or the card stands for several places.
inline constexpr std::uint16_t kStyleCorners = 7;
inline constexpr std::uint16_t kStyleMidside = 8;
inline constexpr std::uint16_t kStyleShifted = 16;

/// Ids are as the cards have them. Runs have frames of the walk (Walk::frames), elements the number of their group plus one as part.
/// Elements that name nodes of instances are noted as "element-between-instances" and left out.
PieceCards read_piece(const Walk& walk, const Piece& piece);

}  // namespace prismesh::mesh::deck::abaqus

// The stage of `assemble` for nodes. Private to assembly.
#pragma once

#include <span>

#include "mesh/deck/assembly/assembled.h"
#include "mesh/deck/assembly/piece_cards.h"
#include "mesh/deck/assembly/warnings.h"

namespace prismesh::mesh::deck {

/// Puts the nodes of the pieces one after the other, by way of `frames` in the basic system. Of equal ids the first counts; the others
/// are warned of. Empties the pieces' arrays of nodes.
AssembledNodes assemble_nodes(std::span<PieceCards> cards, std::span<const Frame> frames, Warnings& warnings);

}  // namespace prismesh::mesh::deck

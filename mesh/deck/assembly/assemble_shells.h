// The stage of `assemble` for shells. Private to assembly.
#pragma once

#include <span>

#include "mesh/deck/assembly/assembled.h"
#include "mesh/deck/assembly/piece_cards.h"
#include "mesh/deck/assembly/warnings.h"

namespace prismesh::mesh::deck {

/// Puts the shells of the pieces one after the other. Shells with a node that nobody defines go to `left_out`; of equal ids of one
/// numbering the first counts, the others go there too; both are warned of. Empties the pieces' arrays of shells.
AssembledShells assemble_shells(std::span<PieceCards> cards, const IdLookup& lookup, LeftOutElements& left_out, Warnings& warnings);

}  // namespace prismesh::mesh::deck

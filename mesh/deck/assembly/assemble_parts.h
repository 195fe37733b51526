// The stage of `assemble` for parts. Private to assembly.
#pragma once

#include <span>
#include <vector>

#include "mesh/deck/assembly/assembled.h"
#include "mesh/deck/assembly/piece_cards.h"

namespace prismesh::mesh::deck {

/// The parts that are defined (ascending by id), and an empty part for each id that only elements name. Masses don't count: the parts
/// that they name aren't theirs.
AssembledParts assemble_parts(std::span<const PieceCards> cards, std::vector<Part> defined);

}  // namespace prismesh::mesh::deck

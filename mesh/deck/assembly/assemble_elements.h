// The stage of `assemble` for elements other than shells. Private to assembly.
#pragma once

#include <array>
#include <memory>
#include <span>

#include "mesh/deck/assembly/assembled.h"
#include "mesh/deck/assembly/piece_cards.h"
#include "mesh/deck/assembly/warnings.h"

namespace prismesh::mesh::deck {

/// The elements of each class ([shell] stays null). Elements with a node that nobody defines go to `left_out`; of equal ids of a class
/// the first counts; both are warned of. Empties the pieces' elements.
std::array<std::shared_ptr<const ElementBlock>, kElementClassCount> assemble_elements(std::span<PieceCards> cards, const IdLookup& lookup,
                                                                                      LeftOutElements& left_out, Warnings& warnings);

}  // namespace prismesh::mesh::deck

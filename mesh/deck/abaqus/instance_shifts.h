// What is added to the ids of a keyword's data lines, for each instance that they stand for.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/deck/abaqus/outline.h"

namespace prismesh::mesh::deck::abaqus {

/// `given`: the parameters of the block's keyword line. Empty: the block stands for no instance of the deck.
std::vector<std::int64_t> shifts_of(const DeckOutline& outline, const Block& block, const Parameters& given);

}  // namespace prismesh::mesh::deck::abaqus

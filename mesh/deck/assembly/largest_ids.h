// The largest ids that the pieces of a deck define.
#pragma once

#include <cstdint>
#include <span>

#include "mesh/deck/assembly/piece_cards.h"

namespace prismesh::mesh::deck {

struct LargestIds {
  std::int64_t node = 0;
  std::int64_t element = 0;  ///< of any class
};

LargestIds largest_ids(std::span<const PieceCards> pieces);

}  // namespace prismesh::mesh::deck

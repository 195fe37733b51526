#include "mesh/deck/assembly/largest_ids.h"

#include <algorithm>

namespace prismesh::mesh::deck {

LargestIds largest_ids(std::span<const PieceCards> pieces) {
  LargestIds largest;
  const auto raise = [](std::int64_t& to, const std::vector<std::int64_t>& ids) {
    if (!ids.empty()) to = std::max(to, *std::max_element(ids.begin(), ids.end()));
  };
  for (const PieceCards& piece : pieces) {
    raise(largest.node, piece.node_id);
    raise(largest.element, piece.shells.id);
    for (const RawElements& elements : piece.elements) raise(largest.element, elements.id);
  }
  return largest;
}

}  // namespace prismesh::mesh::deck

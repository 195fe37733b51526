#include "mesh/deck/assembly/gather.h"

namespace prismesh::mesh::deck {

std::vector<std::uint32_t> indices_after(const std::vector<std::uint8_t>& keep) {
  std::vector<std::uint32_t> after(keep.size() + 1);
  for (std::size_t i = 0; i < keep.size(); ++i) after[i + 1] = after[i] + keep[i];
  return after;
}

}  // namespace prismesh::mesh::deck

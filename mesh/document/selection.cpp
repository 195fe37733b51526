#include "mesh/document/selection.h"

#include <algorithm>
#include <iterator>
#include <span>
#include <vector>

namespace prismesh::mesh::document {

namespace {

/// Indices whose mark has `bit`, ascending.
template <class IndexType>
std::vector<IndexType> marked(const ChunkedArray<std::uint8_t>& marks, std::uint8_t bit, std::size_t expected) {
  std::vector<IndexType> set;
  if (expected == 0) return set;
  set.reserve(expected);
  const void* empty = nullptr;  // a chunk without marks: all untouched chunks are the same one
  for (std::size_t c = 0; c < marks.chunk_count(); ++c) {
    if (marks.chunk_owner(c).get() == empty) continue;
    const std::span<const std::uint8_t> chunk = marks.chunk(c);
    const std::size_t before = set.size();
    for (std::size_t i = 0; i < chunk.size(); ++i)
      if ((chunk[i] & bit) != 0) set.push_back(IndexType(c * kChunkSize + i));
    if (set.size() == before) empty = marks.chunk_owner(c).get();
    if (set.size() == expected) break;
  }
  return set;
}

template <class IndexType>
void put_marks(ChunkedArray<std::uint8_t>& marks, const std::vector<IndexType>& before, const std::vector<IndexType>& after,
               std::uint8_t bit) {
  std::vector<IndexType> changed;
  std::set_symmetric_difference(before.begin(), before.end(), after.begin(), after.end(), std::back_inserter(changed));
  for (std::size_t i = 0; i < changed.size();) {
    const std::size_t c = changed[i].value / kChunkSize;
    const std::span<std::uint8_t> chunk = marks.own_chunk(c);
    for (; i < changed.size() && changed[i].value / kChunkSize == c; ++i) {
      std::uint8_t& mark = chunk[changed[i].value % kChunkSize];
      mark = static_cast<std::uint8_t>(mark ^ bit);
    }
  }
}

}  // namespace

NodeSet selected_nodes(const Generation& generation) {
  return marked<NodeIndex>(generation.node_marks, kSelected, generation.selected_nodes);
}

ShellSet selected_shells(const Generation& generation) {
  return marked<ShellIndex>(generation.shell_marks, kSelected, generation.selected_shells);
}

Selection selection_of(const Generation& generation) {
  return {selected_nodes(generation), selected_shells(generation), generation.selection_kind};
}

void put_selection(Generation& next, const Selection& before, const Selection& after) {
  put_marks(next.node_marks, before.nodes, after.nodes, kSelected);
  put_marks(next.shell_marks, before.shells, after.shells, kSelected);
  next.selection_kind = after.kind;
  next.selected_nodes = after.nodes.size();
  next.selected_shells = after.shells.size();
}

}  // namespace prismesh::mesh::document

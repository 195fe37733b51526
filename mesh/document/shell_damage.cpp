#include "mesh/document/shell_damage.h"

#include <algorithm>
#include <vector>

#include "mesh/model/topology_change.h"

namespace prismesh::mesh::document {

using quality::ShellState;

const ChunkedArray<ShellState>& ShellDamage::of(const std::shared_ptr<const Generation>& opened, const Generation& now) {
  if (opened_ != opened) {
    opened_ = opened;
    quality_ = {};
    damage_ = ChunkedArray<ShellState>::filled(now.quality.size());
  }
  if (damage_.size() != now.quality.size()) damage_.resize(now.quality.size());
  std::vector<ShellState> fresh;
  for (std::size_t c = 0; c < now.quality.chunk_count(); ++c) {
    if (c < quality_.chunk_count() && quality_.chunk_owner(c) == now.quality.chunk_owner(c)) continue;
    const std::span<const ShellState> states = now.quality.chunk(c);
    fresh.assign(states.size(), {});
    for (std::size_t i = 0; i < states.size(); ++i) {
      const ShellIndex shell(c * kChunkSize + i);
      if (states[i].warn == 0 || now.model.is_removed(shell)) continue;
      const std::size_t ancestor = deck_ancestor(now.model, shell).value;
      const ShellState was = ancestor < opened->quality.size() ? opened->quality[ancestor] : ShellState{};
      fresh[i] = {static_cast<std::uint16_t>((states[i].warn & ~was.warn) | (states[i].fail & ~was.fail)),
                  static_cast<std::uint16_t>(states[i].fail & ~was.fail)};
    }
    if (!std::equal(fresh.begin(), fresh.end(), damage_.chunk(c).begin()))
      std::copy(fresh.begin(), fresh.end(), damage_.own_chunk(c).begin());
  }
  quality_ = now.quality;
  return damage_;
}

}  // namespace prismesh::mesh::document

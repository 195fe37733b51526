// A parallel loop that can be cancelled between blocks. Private to mesh/relax.
#pragma once

#include <algorithm>
#include <cstddef>

#include "base/parallel_for.h"

namespace prismesh::mesh::relax {

/// Nodes or shells in a block: some 50 ms of the slowest such work on one core.
inline constexpr std::size_t kInterruptibleBlock = 8192;

/// Runs parallel_for block by block. The calling thread calls `goes_on(share done)` between blocks; false ends the loop. Returns whether
/// all was done.
template <class GoesOn, class Body>
bool parallel_for_interruptible(std::size_t count, std::size_t grain, const GoesOn& goes_on, const Body& body) {
  for (std::size_t first = 0; first < count; first += kInterruptibleBlock) {
    if (first > 0 && !goes_on(static_cast<double>(first) / static_cast<double>(count))) return false;
    parallel_for(std::min(kInterruptibleBlock, count - first), grain,
                 [&](std::size_t begin, std::size_t end) { body(first + begin, first + end); });
  }
  return true;
}

}  // namespace prismesh::mesh::relax

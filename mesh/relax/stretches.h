// Long loops in stretches: between two of them whoever waits is asked whether to go on. Private to mesh/relax.
#pragma once

#include <algorithm>
#include <cstddef>

#include "base/parallel_for.h"

namespace prismesh::mesh::relax {

/// Nodes or shells between two questions: some 50 ms of the slowest such work on one core.
inline constexpr std::size_t kStretch = 8192;

/// parallel_for, stretch by stretch. `goes_on(share of it that is done)` is asked between them by the thread that calls; false ends it.
/// Returns whether everything was done.
template <class GoesOn, class Body>
bool parallel_in_stretches(std::size_t count, std::size_t grain, const GoesOn& goes_on, const Body& body) {
  for (std::size_t first = 0; first < count; first += kStretch) {
    if (first > 0 && !goes_on(static_cast<double>(first) / static_cast<double>(count))) return false;
    parallel_for(std::min(kStretch, count - first), grain, [&](std::size_t begin, std::size_t end) { body(first + begin, first + end); });
  }
  return true;
}

}  // namespace prismesh::mesh::relax

// Works through all shells of a model so that it can be stopped. Private to mesh/contact.
#pragma once

#include <algorithm>
#include <cstddef>

#include "base/parallel_for.h"
#include "base/progress.h"

namespace prismesh::mesh::contact {

inline constexpr std::size_t kShellsOfBatch = 65'536;  ///< a multiple of the grains

/// Calls `body(begin, end)` for ranges of [0, count) that begin at multiples of the grain, on all cores. False: it was stopped.
template <class Body>
bool in_batches(std::size_t count, std::size_t grain, const Progress& progress, Body&& body) {
  for (std::size_t first = 0; first < count; first += kShellsOfBatch) {
    const std::size_t shells = std::min(kShellsOfBatch, count - first);
    parallel_for(shells, grain, [&](std::size_t begin, std::size_t end) { body(first + begin, first + end); });
    if (progress && !progress(static_cast<double>(first + shells) / static_cast<double>(count))) return false;
  }
  return true;
}

}  // namespace prismesh::mesh::contact

// Runs a loop on all cores, with a result that doesn't depend on the number of threads. All parallel work of the project goes through it.
#pragma once

#include <cstddef>
#include <functional>

namespace prismesh {

/// Calls `body(begin, end)` on disjoint ranges that cover [0, count), each at least `grain` long where possible.
/// The ranges begin at multiples of `grain`, whatever the number of threads, so that a reduction stored per range and summed in order
/// is deterministic. Runs inline when count <= grain.
void parallel_for(std::size_t count, std::size_t grain, const std::function<void(std::size_t begin, std::size_t end)>& body);

}  // namespace prismesh

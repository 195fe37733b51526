// Counts this thread's allocations: what happens in a tick mustn't make any.
#pragma once

#include <cstdint>

namespace prismesh::drivers::port {

std::uint64_t allocations_of_this_thread();

}  // namespace prismesh::drivers::port

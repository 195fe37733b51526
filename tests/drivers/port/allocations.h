// Counts this thread's allocations, to check that a tick makes none.
#pragma once

#include <cstdint>

namespace prismesh::drivers::port {

std::uint64_t allocations_of_this_thread();

}  // namespace prismesh::drivers::port

// Counts the bytes that this program has allocated with new.
#pragma once

#include <cstddef>

namespace prismesh::cost {

/// Begins a measurement: the peak is counted above what is allocated now.
void begin_memory_peak();
/// Max bytes allocated at once since then, without what was allocated before.
std::size_t memory_peak_bytes();

}  // namespace prismesh::cost

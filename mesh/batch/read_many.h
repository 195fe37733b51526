// Reading many results at once.
#pragma once

#include <cstddef>
#include <functional>

namespace prismesh::mesh::batch {

/// Calls `each(begin, end)` once for each block of [0, count), on more threads than there may be processors: on a file system in the
/// network a reader mostly waits for answers. Blocks of several threads must not write to the same place. Returns when all have ended.
void read_many(std::size_t count, const std::function<void(std::size_t begin, std::size_t end)>& each);

}  // namespace prismesh::mesh::batch

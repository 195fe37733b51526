// A machine that has no more memory for large things: `operator new` of the whole test program.
#pragma once

#include <cstddef>

namespace prismesh::test {

/// Allocations of `size` bytes or more fail from now on, in every thread.
void refuse_allocations_from(std::size_t size);
void allow_all_allocations();

}  // namespace prismesh::test

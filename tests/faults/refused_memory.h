// A machine that has no more memory for large things: `operator new` of the whole test program.
#pragma once

#include <cstddef>

namespace prismesh::test {

/// Allocations of `size` bytes or more fail from now on, in every thread or in those that are marked.
enum class Where : unsigned char { everywhere, in_marked_threads };
void refuse_allocations_from(std::size_t size, Where where = Where::everywhere);
void mark_this_thread();
void allow_all_allocations();

}  // namespace prismesh::test

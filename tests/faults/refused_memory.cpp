#include "tests/faults/refused_memory.h"

#include <atomic>
#include <cstdlib>
#include <limits>
#include <new>

namespace {
std::atomic<std::size_t> refused_from{std::numeric_limits<std::size_t>::max()};
std::atomic<bool> only_marked{false};
thread_local bool marked = false;
}  // namespace

// Replaces the library's own for the whole test program.
void* operator new(std::size_t size) {
  if (size < refused_from || (only_marked && !marked))
    if (void* memory = std::malloc(size == 0 ? 1 : size); memory != nullptr) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace prismesh::test {

void refuse_allocations_from(std::size_t size, Where where) {
  only_marked = where == Where::in_marked_threads;
  refused_from = size;
}
void mark_this_thread() { marked = true; }
void allow_all_allocations() { refused_from = std::numeric_limits<std::size_t>::max(); }

}  // namespace prismesh::test

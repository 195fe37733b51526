#include "tests/cost/memory.h"

#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <new>

namespace {

// The program has one thread at work; atomic, so that a second one would do no harm.
std::atomic<std::int64_t> live{0}, highest{0}, at_begin{0};

void* counted(void* memory) {
  if (memory == nullptr) throw std::bad_alloc();
  const std::int64_t now = live.load(std::memory_order_relaxed) + static_cast<std::int64_t>(malloc_usable_size(memory));
  live.store(now, std::memory_order_relaxed);
  if (now > highest.load(std::memory_order_relaxed)) highest.store(now, std::memory_order_relaxed);
  return memory;
}

void release(void* memory) {
  live.store(live.load(std::memory_order_relaxed) - static_cast<std::int64_t>(malloc_usable_size(memory)), std::memory_order_relaxed);
  std::free(memory);
}

}  // namespace

// Replace the library's operators for the whole program; its other forms call these.
void* operator new(std::size_t size) { return counted(std::malloc(size == 0 ? 1 : size)); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  const auto step = static_cast<std::size_t>(alignment);
  return counted(std::aligned_alloc(step, (std::max<std::size_t>(size, 1) + step - 1) / step * step));
}
void operator delete(void* memory) noexcept { release(memory); }
void operator delete(void* memory, std::size_t) noexcept { release(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { release(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { release(memory); }

namespace prismesh::cost {

void begin_memory_peak() {
  at_begin = live.load();
  highest = live.load();
}

std::size_t memory_peak_bytes() { return static_cast<std::size_t>(highest - at_begin); }

}  // namespace prismesh::cost

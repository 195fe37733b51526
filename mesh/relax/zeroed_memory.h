// Arrays that the system zeroes page by page on first use, so that one for a large model costs nothing before. Private to mesh/relax.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>

namespace prismesh::mesh::relax {

struct FreeZeroed {
  void operator()(void* memory) const { std::free(memory); }
};
/// `T`: atomics and other types for which zeros are a value and that need no destructor.
template <class T>
using ZeroedMemory = std::unique_ptr<T[], FreeZeroed>;

template <class T>
ZeroedMemory<T> zeroed(std::size_t count) {
  void* memory = std::calloc(std::max<std::size_t>(count, 1), sizeof(T));
  if (memory == nullptr) throw std::bad_alloc();
  return ZeroedMemory<T>(static_cast<T*>(memory));
}

}  // namespace prismesh::mesh::relax

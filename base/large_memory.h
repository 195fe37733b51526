// Memory for arrays of many megabytes, in pages of 2 MB. The kernel gives untouched memory in pages of 4 KB; the page faults cost more
// than most work on the array, and large pages cost a tenth. Where the kernel has none, everything works the same, but slower.
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <new>
#include <utility>
#include <vector>

namespace prismesh {

inline constexpr std::size_t kLargePage = std::size_t{2} << 20;

/// Advises the kernel to use large pages where they fit wholly into [begin, begin + bytes). The memory must not have been touched yet.
void prefer_large_pages(void* begin, std::size_t bytes);

/// Reserves room for `count` elements in a vector, in large pages where that pays. Call it before the vector grows.
template <class T>
void reserve_large(std::vector<T>& values, std::size_t count) {
  if (count <= values.capacity()) return;
  values.reserve(count);
  if (values.empty() && count * sizeof(T) >= 2 * kLargePage) prefer_large_pages(values.data(), count * sizeof(T));
}

/// Owns bytes aligned to large pages.
class LargeBlock {
 public:
  LargeBlock() = default;
  /// Zeros. Throws std::bad_alloc.
  explicit LargeBlock(std::size_t bytes);
  LargeBlock(LargeBlock&& other) noexcept;
  LargeBlock& operator=(LargeBlock&& other) noexcept;
  ~LargeBlock();
  char* data() const { return data_; }
  std::size_t size() const { return size_; }

 private:
  char* data_ = nullptr;
  std::size_t size_ = 0;
  std::size_t mapped_ = 0;  ///< 0: it came from the heap
};

/// Makes objects in large blocks, on any thread. A block is freed with its last object, so put only objects of similar lifetime into
/// one pool.
class LargePool {
 public:
  /// Makes an object in zeroed memory.
  template <class T>
  std::shared_ptr<T> make() {
    static_assert(alignof(T) <= kAlignment);
    auto [place, block] = take(sizeof(T));
    return std::shared_ptr<T>(new (place) T, [block = std::move(block)](T* object) { std::destroy_at(object); });
  }

 private:
  static constexpr std::size_t kAlignment = 64;
  std::pair<void*, std::shared_ptr<const LargeBlock>> take(std::size_t bytes);

  std::mutex mutex_;
  std::shared_ptr<const LargeBlock> block_;
  std::size_t used_ = 0;
};

}  // namespace prismesh

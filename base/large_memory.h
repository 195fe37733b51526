// Memory for arrays of many megabytes. Untouched memory comes from the kernel in pages of 4 KB, and fetching them one by one costs more
// than most of what is done with them; pages of 2 MB cost a tenth. Where the kernel has none, all works the same, only slower.
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <new>
#include <utility>
#include <vector>

namespace prismesh {

inline constexpr std::size_t kLargePage = std::size_t{2} << 20;

/// Asks for large pages where they fit wholly into [begin, begin + bytes), for memory that hasn't been touched yet. Only advice.
void prefer_large_pages(void* begin, std::size_t bytes);

/// Room for `count` elements in a vector, in large pages where that pays. To be called before the vector grows.
template <class T>
void reserve_large(std::vector<T>& values, std::size_t count) {
  if (count <= values.capacity()) return;
  values.reserve(count);
  if (values.empty() && count * sizeof(T) >= 2 * kLargePage) prefer_large_pages(values.data(), count * sizeof(T));
}

/// Bytes of its own, aligned to large pages; given back when it goes.
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

/// Makes objects in large blocks, from any thread. A block goes when all its objects have gone, so only objects that live about
/// equally long belong together.
class LargePool {
 public:
  /// An object in the pool, of all bytes zero but what its default constructor writes.
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

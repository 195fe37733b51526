// An array in fixed-size chunks, copied on write: a copy shares every chunk that neither side changed since.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace prismesh::mesh {

inline constexpr std::size_t kChunkSize = 4096;  ///< elements of a chunk, whatever their type, unless an array says otherwise

/// Copying costs a pointer a chunk; writing to a shared chunk copies that chunk first. Reading is safe from any number of
/// threads; writing to distinct chunks of one array from several threads is safe after `own_chunk` of each.
/// A chunk's address stands for its content as long as any array holds it: equal addresses mean equal content.
template <class T, std::size_t kSize = kChunkSize>
class ChunkedArray {
 public:
  using Chunk = std::array<T, kSize>;

  ChunkedArray() = default;
  explicit ChunkedArray(std::size_t size, const T& value = T()) { resize(size, value); }

  /// An array whose chunks are all the same one: costs one chunk and a pointer for each, until a chunk is written to (which
  /// copies it first). For arrays that are mostly one value.
  static ChunkedArray filled(std::size_t size, const T& value = T()) {
    ChunkedArray array;
    if (size == 0) return array;
    const auto chunk = std::make_shared<Chunk>();
    chunk->fill(value);
    array.chunks_.assign((size + kSize - 1) / kSize, chunk);
    array.size_ = size;
    return array;
  }

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  std::size_t chunk_count() const { return chunks_.size(); }

  const T& operator[](std::size_t i) const { return (*chunks_[i / kSize])[i % kSize]; }

  /// The used elements of a chunk.
  std::span<const T> chunk(std::size_t c) const { return {chunks_[c]->data(), std::min(kSize, size_ - c * kSize)}; }
  /// The owner of a chunk. While it lives, the chunk's address stands for its content.
  const std::shared_ptr<Chunk>& chunk_owner(std::size_t c) const { return chunks_[c]; }
  bool shares_chunk(const ChunkedArray& other, std::size_t c) const {
    return c < other.chunks_.size() && chunks_[c] == other.chunks_[c] && size_ == other.size_;
  }

  /// The chunk for writing, copied first if another array shares it.
  std::span<T> own_chunk(std::size_t c) {
    if (chunks_[c].use_count() > 1) chunks_[c] = std::make_shared<Chunk>(*chunks_[c]);
    return {chunks_[c]->data(), std::min(kSize, size_ - c * kSize)};
  }
  /// Sets the size without content: every chunk must be set by `put_chunk` before any other call, distinct chunks from any thread.
  void reset(std::size_t size) {
    chunks_.assign((size + kSize - 1) / kSize, nullptr);
    size_ = size;
  }
  /// Sets a chunk, and returns it for writing.
  std::span<T> put_chunk(std::size_t c, std::shared_ptr<Chunk> chunk) {
    chunks_[c] = std::move(chunk);
    return own_chunk(c);
  }
  void set(std::size_t i, const T& value) { own_chunk(i / kSize)[i % kSize] = value; }

  /// New elements get `value`.
  void resize(std::size_t size, const T& value = T()) {
    const std::size_t old = size_;
    if (size > old && old % kSize != 0) {
      size_ = std::min(size, (old / kSize + 1) * kSize);
      std::span<T> last = own_chunk(old / kSize);
      std::fill(last.begin() + static_cast<std::ptrdiff_t>(old % kSize), last.end(), value);
    }
    chunks_.resize((size + kSize - 1) / kSize);
    for (auto& chunk : chunks_)
      if (!chunk) {
        chunk = std::make_shared<Chunk>();
        chunk->fill(value);
      }
    size_ = size;
  }

 private:
  std::vector<std::shared_ptr<Chunk>> chunks_;
  std::size_t size_ = 0;
};

/// Whether two arrays share all chunks, and so have the same content. Costs the chunks.
template <class T, std::size_t kSize>
bool same_chunks(const ChunkedArray<T, kSize>& a, const ChunkedArray<T, kSize>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t c = 0; c < a.chunk_count(); ++c)
    if (!a.shares_chunk(b, c)) return false;
  return true;
}

}  // namespace prismesh::mesh

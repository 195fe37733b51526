// A value in shared memory with one writer and any number of readers; none waits for another. The writer alternates between two buffers,
// and a count tells which one is complete. A writer that dies during a write leaves the last complete value, and the next writer continues.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <type_traits>

namespace prismesh::ipc {

static_assert(std::atomic_ref<std::uint64_t>::is_always_lock_free, "shared memory needs atomics without locks");

/// The count of a pair of buffers. Value n is in buffer n % 2; count 0 means that nothing was written yet.
///
/// No fences (they can't be checked by ThreadSanitizer): words are stored with release and loaded with acquire. A reader that
/// sees a word of value n + 2 in the buffer of value n therefore sees the count n + 1, which was stored before that word, and
/// discards its copy.
class TurnCount {
 public:
  std::uint64_t load() const { return std::atomic_ref(const_cast<std::uint64_t&>(count_)).load(std::memory_order_acquire); }
  void store(std::uint64_t count) { std::atomic_ref(count_).store(count, std::memory_order_release); }

 private:
  std::uint64_t count_ = 0;
};

inline void store_words(std::uint64_t* to, const std::uint64_t* from, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) std::atomic_ref(to[i]).store(from[i], std::memory_order_release);
}
/// `from` may lie in memory that is mapped read-only: it is only loaded.
inline void load_words(std::uint64_t* to, const std::uint64_t* from, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) to[i] = std::atomic_ref(const_cast<std::uint64_t&>(from[i])).load(std::memory_order_acquire);
}

/// A small value in shared memory. A slot of zeros was never written.
template <class T>
requires std::is_trivially_copyable_v<T>
class SeqlockSlot {
 public:
  void write(const T& value) {
    std::array<std::uint64_t, kWords> words{};
    std::memcpy(words.data(), &value, sizeof value);
    const std::uint64_t next = count_.load() + 1;
    store_words(words_[next % 2].data(), words.data(), kWords);
    count_.store(next);
  }

  /// The newest value and, in `count`, how many were written up to it. Empty if none was written, or if the writer published during each of
  /// several attempts to copy.
  std::optional<T> read(std::uint64_t* count = nullptr) const {
    for (int attempt = 0; attempt < 16; ++attempt) {
      const std::uint64_t now = count_.load();
      if (now == 0) return std::nullopt;
      std::array<std::uint64_t, kWords> words;
      load_words(words.data(), words_[now % 2].data(), kWords);
      if (count_.load() != now) continue;
      T value;
      std::memcpy(static_cast<void*>(&value), words.data(), sizeof value);
      if (count != nullptr) *count = now;
      return value;
    }
    return std::nullopt;
  }

 private:
  static constexpr std::size_t kWords = (sizeof(T) + 7) / 8;
  alignas(64) TurnCount count_;
  std::array<std::array<std::uint64_t, kWords>, 2> words_{};
};

}  // namespace prismesh::ipc

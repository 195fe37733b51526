// A wait-free queue of fixed size from one writing thread to one reading thread. It doesn't allocate.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <optional>
#include <type_traits>

namespace prismesh {

template <class T, std::size_t Places>
requires std::is_trivially_copyable_v<T>
class Ring {
 public:
  /// Called by the writing thread. Returns false if the queue is full; then nothing is added.
  bool push(const T& value) {
    const std::size_t at = written_.load(std::memory_order_relaxed);
    if (at - read_.load(std::memory_order_acquire) == Places) return false;
    places_[at % Places] = value;
    written_.store(at + 1, std::memory_order_release);
    return true;
  }

  /// Called by the reading thread. Returns nothing if the queue is empty.
  std::optional<T> pop() {
    const std::size_t at = read_.load(std::memory_order_relaxed);
    if (at == written_.load(std::memory_order_acquire)) return std::nullopt;
    std::optional<T> value = places_[at % Places];
    read_.store(at + 1, std::memory_order_release);
    return value;
  }

 private:
  static_assert((Places & (Places - 1)) == 0, "counts run over: a power of two keeps their places");
  std::array<T, Places> places_{};
  alignas(64) std::atomic<std::size_t> written_{0};
  alignas(64) std::atomic<std::size_t> read_{0};
};

}  // namespace prismesh

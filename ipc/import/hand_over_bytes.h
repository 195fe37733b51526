// The two directions of a hand-over: one description of the fields (hand_over.cpp) is walked by a counter, a writer and a reader.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "mesh/model/chunked_array.h"
#include "mesh/model/model.h"

namespace prismesh::ipc {

/// Numbers and structs of numbers, which mean something whatever their bytes are. A bool or an enum doesn't.
template <class T>
concept PlainBytes = std::is_same_v<T, mesh::Vec3> ||
    (std::is_trivially_copyable_v<T> && !std::is_same_v<T, bool> && !std::is_enum_v<T> && !std::is_pointer_v<T>);

/// Where the writer puts bytes: counts them, and copies them where there is space.
class HandOverWriter {
 public:
  static constexpr bool kReads = false;

  HandOverWriter() = default;
  explicit HandOverWriter(std::span<std::byte> out) : out_(out) {}
  std::size_t size() const { return size_; }

  template <PlainBytes T>
  void number(const T& value) {
    put(&value, sizeof value);
  }
  void flag(const bool& value) { number(static_cast<std::uint8_t>(value)); }
  template <class T>
  void choice(const T& value, std::uint8_t /*last*/) {
    number(static_cast<std::uint8_t>(value));
  }
  void text(const std::string& text) {
    number(std::uint64_t{text.size()});
    put(text.data(), text.size());
  }
  void bytes(std::string_view text) {
    number(std::uint64_t{text.size()});
    put(text.data(), text.size());
  }
  template <PlainBytes T>
  void array(const std::vector<T>& values) {
    number(std::uint64_t{values.size()});
    put(values.data(), values.size() * sizeof(T));
  }
  template <PlainBytes T, std::size_t kSize>
  void array(const mesh::ChunkedArray<T, kSize>& values) {
    number(std::uint64_t{values.size()});
    for (std::size_t c = 0; c < values.chunk_count(); ++c) put(values.chunk(c).data(), values.chunk(c).size_bytes());
  }
  template <class T, class Each>
  void list(const std::vector<T>& values, std::size_t /*min_bytes*/, const Each& each) {
    number(std::uint64_t{values.size()});
    for (const T& value : values) each(value);
  }
  template <class T, class Each>
  void maybe(const std::optional<T>& value, const Each& each) {
    flag(value.has_value());
    if (value) each(*value);
  }

 private:
  void put(const void* data, std::size_t size) {
    if (size > 0 && size <= out_.size() - std::min(size_, out_.size())) std::memcpy(out_.data() + size_, data, size);
    size_ += size;
  }

  std::span<std::byte> out_;
  std::size_t size_ = 0;
};

/// Reads never pass the end. After the first fault everything read is empty, and `fault` says what it was.
class HandOverReader {
 public:
  static constexpr bool kReads = true;

  explicit HandOverReader(std::span<const std::byte> bytes) : rest_(bytes) {}
  const std::string& fault() const { return fault_; }
  bool ok() const { return fault_.empty(); }
  bool at_end() const { return rest_.empty(); }

  template <PlainBytes T>
  void number(T& value) {
    const std::span<const std::byte> from = take(sizeof value);
    if (!from.empty()) std::memcpy(static_cast<void*>(&value), from.data(), sizeof value);
  }
  void flag(bool& value) {
    std::uint8_t byte = 0;
    number(byte);
    if (byte > 1) stop("a flag has the value " + std::to_string(byte));
    value = byte == 1;
  }
  template <class T>
  void choice(T& value, std::uint8_t last) {
    std::uint8_t byte = 0;
    number(byte);
    if (byte > last) stop("a kind has the number " + std::to_string(byte));
    if (ok()) value = static_cast<T>(byte);
  }
  void text(std::string& text) { text = bytes(); }
  std::string_view bytes() {
    const std::span<const std::byte> from = take(count(1));
    return {reinterpret_cast<const char*>(from.data()), from.size()};
  }
  template <PlainBytes T>
  void array(std::vector<T>& values) {
    const std::span<const std::byte> from = take(count(sizeof(T)) * sizeof(T));
    values.resize(from.size() / sizeof(T));
    if (!from.empty()) std::memcpy(static_cast<void*>(values.data()), from.data(), from.size());
  }
  template <PlainBytes T, std::size_t kSize>
  void array(mesh::ChunkedArray<T, kSize>& values) {
    std::span<const std::byte> from = take(count(sizeof(T)) * sizeof(T));
    values.resize(from.size() / sizeof(T));
    for (std::size_t c = 0; c < values.chunk_count(); ++c) {
      const std::span<T> chunk = values.own_chunk(c);
      std::memcpy(static_cast<void*>(chunk.data()), from.data(), chunk.size_bytes());
      from = from.subspan(chunk.size_bytes());
    }
  }
  /// `min_bytes`: that an entry takes at least.
  template <class T, class Each>
  void list(std::vector<T>& values, std::size_t min_bytes, const Each& each) {
    const std::size_t size = count(min_bytes);
    values.clear();
    for (std::size_t i = 0; ok() && i < size; ++i) each(values.emplace_back());
  }
  template <class T, class Each>
  void maybe(std::optional<T>& value, const Each& each) {
    bool is_there = false;
    flag(is_there);
    value.reset();
    if (is_there) each(value.emplace());
  }

 private:
  void stop(std::string fault) {
    if (ok()) fault_ = std::move(fault);
    rest_ = {};
  }
  /// The number of entries that follow; 0 where so many can't follow.
  std::size_t count(std::size_t min_bytes) {
    std::uint64_t value = 0;
    number(value);
    if (value > rest_.size() / min_bytes) {
      stop("a list of " + std::to_string(value) + " entries is longer than what follows");
      return 0;
    }
    return static_cast<std::size_t>(value);
  }
  std::span<const std::byte> take(std::size_t size) {
    if (size > rest_.size()) stop("it ends early");
    if (!ok()) return {};
    const std::span<const std::byte> taken = rest_.first(size);
    rest_ = rest_.subspan(size);
    return taken;
  }

  std::span<const std::byte> rest_;
  std::string fault_;
};

}  // namespace prismesh::ipc

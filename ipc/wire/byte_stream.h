// Writes and reads small binary records in native byte order, for processes on one machine. Reading never passes the end; after the
// first failure every value read is zero and `ok` stays false.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace prismesh::ipc {

class ByteWriter {
 public:
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void put(const T& value) {
    const auto* data = reinterpret_cast<const std::byte*>(&value);
    bytes_.insert(bytes_.end(), data, data + sizeof value);
  }
  void put(const std::string& text) {
    put(std::uint64_t{text.size()});
    const auto* data = reinterpret_cast<const std::byte*>(text.data());
    bytes_.insert(bytes_.end(), data, data + text.size());
  }
  const std::vector<std::byte>& bytes() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : rest_(bytes) {}

  template <class T>
  requires std::is_trivially_copyable_v<T> T get() {
    T value{};
    if (const std::span<const std::byte> from = take(sizeof value); !from.empty()) std::memcpy(&value, from.data(), sizeof value);
    return value;
  }
  std::string text() {
    const auto size = get<std::uint64_t>();
    if (size > rest_.size()) {
      ok_ = false;
      return {};
    }
    const std::span<const std::byte> from = take(static_cast<std::size_t>(size));
    return {reinterpret_cast<const char*>(from.data()), from.size()};
  }
  /// Whether `count` records of at least `size` bytes can still follow. Check it before reserving memory for them.
  bool holds(std::uint64_t count, std::size_t size) const { return ok_ && count <= rest_.size() / size; }
  bool ok() const { return ok_; }
  bool at_end() const { return rest_.empty(); }

 private:
  std::span<const std::byte> take(std::size_t size) {
    if (!ok_ || size > rest_.size()) {
      ok_ = false;
      return {};
    }
    const std::span<const std::byte> taken = rest_.first(size);
    rest_ = rest_.subspan(size);
    return taken;
  }

  std::span<const std::byte> rest_;
  bool ok_ = true;
};

}  // namespace prismesh::ipc

// SHA-256 (FIPS 180-4) by OpenSSL: names what the store holds.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace prismesh::ipc::store {

struct ContentHash {
  std::array<std::uint8_t, 32> bytes{};
  auto operator<=>(const ContentHash&) const = default;

  /// 64 lower-case hexadecimal digits.
  std::string hex() const;
};

/// Nothing: the text isn't what `hex` writes.
std::optional<ContentHash> parse_content_hash(std::string_view text);

/// A hash that is under way. A copy goes on by itself from there.
class Sha256 {
 public:
  Sha256();
  Sha256(const Sha256& other);
  Sha256(Sha256&&) noexcept = default;
  Sha256& operator=(const Sha256& other);
  Sha256& operator=(Sha256&&) noexcept = default;
  ~Sha256() = default;

  void add(std::span<const std::byte> bytes);
  void add(std::string_view text) { add(std::as_bytes(std::span(text.data(), text.size()))); }
  /// The hash of what was added so far.
  ContentHash hash() const;

 private:
  struct Free {
    void operator()(void* context) const;
  };
  std::unique_ptr<void, Free> context_;
};

ContentHash sha256(std::string_view text);

}  // namespace prismesh::ipc::store

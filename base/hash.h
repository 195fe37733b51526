// Content hashes: they identify a deck's content and find damaged records. Not cryptographic.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace prismesh {

struct Hash128 {
  std::uint64_t low = 0;
  std::uint64_t high = 0;
  bool operator==(const Hash128&) const = default;

  /// 32 lower-case hexadecimal digits.
  std::string hex() const;
};

/// XXH3-128 of the bytes.
Hash128 hash128(std::span<const std::byte> bytes);
/// The hash of the concatenated pieces.
Hash128 hash128(std::span<const std::string_view> pieces);
/// XXH3-64 of the bytes.
std::uint64_t hash64(std::span<const std::byte> bytes);

}  // namespace prismesh

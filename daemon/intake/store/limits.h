// How much the store takes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

namespace prismesh::intake {

struct StoreLimits {
  std::uint64_t reserved_bytes = std::uint64_t{2} << 30;  ///< stay free on the disk, for the journals
  std::uint64_t quota_bytes = std::uint64_t{50} << 30;    ///< models and uploads of one token's name
  std::uint64_t file_bytes = std::uint64_t{8} << 30;      ///< one file
  std::uint64_t uploads = 2100;                           ///< at once, of one token's name
  std::int64_t upload_lifetime_s = 24 * 3600;             ///< after the last byte, while the process runs
};

/// Fills the bytes with randomness that can't be guessed.
using Randomness = std::function<void(std::span<std::byte>)>;

}  // namespace prismesh::intake

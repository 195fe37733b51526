// The checksum of one chunk of an upload, as the header Upload-Checksum has it (tus 1.0.0, extension checksum).
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "base/error.h"

namespace prismesh::intake {

enum class ChecksumAlgorithm : std::uint8_t { sha256, sha1 };
inline constexpr std::string_view kChecksumAlgorithms = "sha256,sha1";

struct Checksum {
  ChecksumAlgorithm algorithm = ChecksumAlgorithm::sha256;
  std::string digest;  ///< bytes
  bool operator==(const Checksum&) const = default;
};

/// Reads "sha256 BASE64". Errors: another form, an unknown algorithm, a digest of another length.
Result<Checksum> parse_checksum(std::string_view header);

/// The digest of bytes that come in pieces.
class ChunkDigest {
 public:
  explicit ChunkDigest(ChecksumAlgorithm algorithm);
  void add(std::string_view bytes);
  std::string digest() const;  ///< ends it

 private:
  struct Free {
    void operator()(void* context) const;
  };
  std::unique_ptr<void, Free> context_;
};

}  // namespace prismesh::intake

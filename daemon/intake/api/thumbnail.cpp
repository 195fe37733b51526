#include "daemon/intake/api/thumbnail.h"

#include <cstdint>

namespace prismesh::intake {

namespace {

constexpr std::string_view kSignature("\x89PNG\r\n\x1a\n", 8);
constexpr std::size_t kChunkFrame = 12;  // length, type, checksum
constexpr std::size_t kHeaderBytes = 13;

std::size_t number_at(std::string_view bytes, std::size_t at) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < 4; ++i) number = number << 8 | static_cast<std::uint8_t>(bytes[at + i]);
  return number;
}

bool is_side(std::size_t pixels) { return pixels >= 1 && pixels <= kMaxThumbnailSide; }

}  // namespace

bool is_thumbnail(std::string_view bytes) {
  if (bytes.size() > kMaxThumbnailBytes || !bytes.starts_with(kSignature)) return false;
  std::string_view rest = bytes.substr(kSignature.size());
  for (bool is_first = true; rest.size() >= kChunkFrame; is_first = false) {
    const std::size_t length = number_at(rest, 0);
    const std::string_view type = rest.substr(4, 4);
    if (length > rest.size() - kChunkFrame || is_first != (type == "IHDR")) return false;
    if (is_first && (length != kHeaderBytes || !is_side(number_at(rest, 8)) || !is_side(number_at(rest, 12)))) return false;
    rest.remove_prefix(kChunkFrame + length);
    if (type == "IEND") return length == 0 && rest.empty();
  }
  return false;
}

}  // namespace prismesh::intake

#include "ipc/store/utf8.h"

#include <cstddef>
#include <cstdint>

namespace prismesh::ipc::store {

namespace {

struct Decoded {
  std::uint32_t code = 0;
  std::size_t size = 0;  ///< 0: no sound character
};

Decoded decode_character(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const std::uint8_t first = byte(0);
  if (first < 0x80) return {first, 1};
  const std::size_t size = first >= 0xf0 && first < 0xf8 ? 4 : first >= 0xe0 && first < 0xf0 ? 3 : first >= 0xc0 && first < 0xe0 ? 2 : 0;
  if (size == 0 || text.size() < size) return {};
  std::uint32_t code = first & (0xffU >> (size + 1));
  for (std::size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return {};
    code = code << 6 | (byte(i) & 0x3fU);
  }
  constexpr std::uint32_t kSmallest[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool sound = code >= kSmallest[size] && code <= 0x10ffff && (code < 0xd800 || code > 0xdfff);
  return sound ? Decoded{code, size} : Decoded{};
}

bool is_control(std::uint32_t code) {
  const bool direction = (code >= 0x202a && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069) || code == 0x200e || code == 0x200f;
  return code < 0x20 || (code >= 0x7f && code <= 0x9f) || code == 0x2028 || code == 0x2029 || direction;
}

}  // namespace

bool is_plain_utf8(std::string_view text) {
  while (!text.empty()) {
    const Decoded next = decode_character(text);
    if (next.size == 0 || is_control(next.code)) return false;
    text.remove_prefix(next.size);
  }
  return true;
}

}  // namespace prismesh::ipc::store

// Whatever a monitor or a bad cable sends, reading its EDID ends in facts that can be shown.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "drivers/display/edid.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace prismesh::drivers::display;
  if (size > 1024) return 0;
  std::vector<std::byte> bytes(reinterpret_cast<const std::byte*>(data), reinterpret_cast<const std::byte*>(data) + size);
  // Most inputs get their header and checksums mended, so that the rest is reached.
  if (size >= 128 && data[size - 1] % 8 != 0) {
    for (std::size_t i = 0; i < 8; ++i) bytes[i] = i == 0 || i == 7 ? std::byte{0} : std::byte{0xFF};
    for (std::size_t block = 0; block + 128 <= size; block += 128) {
      unsigned sum = 0;
      for (std::size_t i = 0; i < 127; ++i) sum += std::to_integer<unsigned>(bytes[block + i]);
      bytes[block + 127] = static_cast<std::byte>(256 - sum % 256);
    }
  }
  const auto edid = decode_edid(bytes);
  if (!edid) return 0;
  for (const char c : edid->identity.text())
    if (c < 0x20 || c > 0x7E) std::abort();
  if (edid->width_mm < 0 || edid->native_width < 0 || edid->native_width > 4095) std::abort();
  return 0;
}

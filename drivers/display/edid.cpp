#include "drivers/display/edid.h"

#include <algorithm>
#include <array>

namespace prismesh::drivers::display {
namespace {

constexpr std::size_t kBlockBytes = 128;
constexpr std::array<unsigned, 8> kHeader{0x00, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x00};
constexpr unsigned kCtaExtension = 0x02;
constexpr unsigned kNameDescriptor = 0xFC, kSerialDescriptor = 0xFF;

using Block = std::span<const std::byte, kBlockBytes>;

unsigned at(Block block, std::size_t index) { return std::to_integer<unsigned>(block[index]); }

bool sums_to_zero(Block block) {
  unsigned sum = 0;
  for (const std::byte byte : block) sum += std::to_integer<unsigned>(byte);
  return sum % 256 == 0;
}

std::string maker_of(Block block) {
  const unsigned packed = at(block, 8) << 8 | at(block, 9);  // three letters of five bits, A is 1
  std::string maker;
  for (const int shift : {10, 5, 0}) {
    const unsigned letter = packed >> shift & 31;
    if (letter >= 1 && letter <= 26) maker += static_cast<char>('A' + letter - 1);
  }
  return maker;
}

std::string product_of(Block block) {
  constexpr const char* kDigits = "0123456789ABCDEF";
  const unsigned code = at(block, 11) << 8 | at(block, 10);
  std::string text;
  for (const int shift : {12, 8, 4, 0}) text += kDigits[code >> shift & 15];
  return text;
}

std::string serial_number_of(Block block) {
  const unsigned number = at(block, 12) | at(block, 13) << 8 | at(block, 14) << 16 | at(block, 15) << 24;
  return number == 0 ? std::string() : std::to_string(number);
}

/// Decodes up to 13 characters, ended by a line feed and padded with blanks. Skips unprintable characters, because the kiosk's panels show
/// this text.
std::string text_of(Block block, std::size_t start) {
  std::string text;
  for (std::size_t i = start; i < start + 13 && at(block, i) != '\n'; ++i)
    if (at(block, i) >= 0x20 && at(block, i) < 0x7F) text += static_cast<char>(at(block, i));
  const std::size_t first = text.find_first_not_of(' ');
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(' ') - first + 1);
}

void read_timing(Block block, std::size_t start, Edid& edid) {
  edid.native_width = static_cast<int>(at(block, start + 2) | (at(block, start + 4) & 0xF0) << 4);
  edid.native_height = static_cast<int>(at(block, start + 5) | (at(block, start + 7) & 0xF0) << 4);
  const unsigned width = at(block, start + 12) | (at(block, start + 14) & 0xF0) << 4;
  const unsigned height = at(block, start + 13) | (at(block, start + 14) & 0x0F) << 8;
  // Some monitors store an aspect ratio here; no picture is as small as 16 x 9 mm.
  if (width > 50 && height > 50) {
    edid.width_mm = width;
    edid.height_mm = height;
  }
}

void read_descriptors(Block block, Edid& edid) {
  constexpr std::size_t kFirst = 54, kLast = 108, kBytes = 18;
  for (std::size_t start = kFirst; start <= kLast; start += kBytes) {
    const bool timing = at(block, start) != 0 || at(block, start + 1) != 0;
    if (timing && start == kFirst) read_timing(block, start, edid);  // the preferred timing
    if (timing) continue;
    if (at(block, start + 3) == kNameDescriptor)
      if (std::string name = text_of(block, start + 5); !name.empty()) edid.identity.model = std::move(name);
    if (at(block, start + 3) == kSerialDescriptor)
      if (std::string serial = text_of(block, start + 5); !serial.empty()) edid.identity.serial = std::move(serial);
  }
}

void read_features(Block block, Edid& edid) {
  edid.digital = (at(block, 20) & 0x80) != 0;
  const unsigned version = at(block, 18) * 256 + at(block, 19);
  if (edid.digital && version >= 0x0104) {  // before version 1.4 these bits had a different meaning
    edid.takes_ycbcr_444 = (at(block, 24) & 0x08) != 0;
    edid.takes_ycbcr_422 = (at(block, 24) & 0x10) != 0;
  }
}

}  // namespace

std::string MonitorIdentity::text() const {
  std::string line;
  for (const std::string* part : {&maker, &model, &serial})
    if (!part->empty()) line += (line.empty() ? "" : " ") + *part;
  return line;
}

Result<Edid> decode_edid(std::span<const std::byte> bytes) {
  if (bytes.size() < kBlockBytes) return fail("monitor", "its description (EDID) is shorter than 128 bytes");
  const Block first = bytes.first<kBlockBytes>();
  const bool header = std::equal(kHeader.begin(), kHeader.end(), first.begin(),
                                 [](unsigned wanted, std::byte is) { return wanted == std::to_integer<unsigned>(is); });
  if (!header) return fail("monitor", "what it says of itself isn't an EDID");
  if (!sums_to_zero(first)) return fail("monitor", "its description (EDID) has a wrong checksum; the cable may be bad");
  Edid edid;
  edid.identity = {maker_of(first), product_of(first), serial_number_of(first)};
  edid.width_mm = 10.0 * at(first, 21);
  edid.height_mm = 10.0 * at(first, 22);
  if (edid.width_mm == 0 || edid.height_mm == 0) edid.width_mm = edid.height_mm = 0;  // an aspect ratio is stored instead of a size
  read_features(first, edid);
  read_descriptors(first, edid);
  for (std::size_t start = kBlockBytes; start + kBlockBytes <= bytes.size(); start += kBlockBytes) {
    const Block block = bytes.subspan(start).first<kBlockBytes>();
    if (at(block, 0) != kCtaExtension || !sums_to_zero(block)) continue;
    edid.takes_ycbcr_444 |= (at(block, 3) & 0x20) != 0;
    edid.takes_ycbcr_422 |= (at(block, 3) & 0x10) != 0;
  }
  return edid;
}

}  // namespace prismesh::drivers::display

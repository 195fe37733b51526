#include "drivers/haptic_pen/falcon/firmware.h"

#include <cstdint>

#include <fmt/format.h>

#include "base/file.h"

namespace prismesh::drivers::haptic_pen::falcon {
namespace {

constexpr unsigned kKey = 0x08AA;  // of a stream of bytes
constexpr std::size_t kFirstBlock = 22;
/// All memory of these processors is less.
constexpr std::size_t kMaxBytes = std::size_t{512} * 1024;

unsigned word(std::span<const std::byte> bytes, std::size_t at) {
  return std::to_integer<unsigned>(bytes[at]) | std::to_integer<unsigned>(bytes[at + 1]) << 8;
}

}  // namespace

Result<Firmware> parse_firmware(std::span<const std::byte> bytes, const std::string& file) {
  const auto too_short = [&](std::size_t needed) {
    return fail(file, fmt::format("isn't a whole Falcon firmware: it ends after {} bytes, but needs at least {}; copy it again",
                                  bytes.size(), needed));
  };
  if (bytes.size() > kMaxBytes)
    return fail(file, fmt::format("isn't a Falcon firmware: it has {} bytes, which no such device can hold", bytes.size()));
  if (bytes.size() >= 2 && word(bytes, 0) != kKey)
    return fail(
        file, fmt::format("isn't a Falcon firmware: it begins with {:02X} {:02X}, not AA 08", word(bytes, 0) & 0xFF, word(bytes, 0) >> 8));
  std::size_t at = kFirstBlock, words = 0;
  for (;;) {
    if (bytes.size() < at + 2) return too_short(at + 2);
    const std::size_t count = word(bytes, at);
    at += 2;
    if (count == 0) break;
    words += count;
    at += 4 + 2 * count;
    if (bytes.size() < at) return too_short(at + 2);
  }
  if (words == 0) return fail(file, "isn't a Falcon firmware: it has no program in it");
  if (at != bytes.size()) return fail(file, fmt::format("isn't a Falcon firmware: {} bytes follow its end", bytes.size() - at));
  return Firmware{{bytes.begin(), bytes.end()}};
}

Result<Firmware> read_firmware(const std::filesystem::path& file) {
  const Result<FileBytes> bytes = read_file(file);
  if (!bytes) return fail(bytes.error());
  return parse_firmware(std::as_bytes(std::span(bytes->text())), file.string());
}

}  // namespace prismesh::drivers::haptic_pen::falcon

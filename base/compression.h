// Unpacks and packs files with gzip or zstd. The bytes tell which, not the file's name.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "base/error.h"
#include "base/file.h"
#include "base/progress.h"

namespace prismesh {

enum class Packing : std::uint8_t { none, gzip, zstd };

/// Judges by the first bytes. A file of nothing but the first two bytes of a gzip file is one that was cut off.
Packing packing_of(std::span<const std::byte> bytes);

/// The largest size that `packed_bytes`, a file or its beginning, may unpack to: a file that holds more was made to exhaust memory. No real
/// text packs nearly as well.
constexpr std::size_t max_unpacked(std::size_t packed_bytes) { return 200 * packed_bytes + (std::size_t{2} << 20); }

/// The largest size that the packed files of a deck may unpack to, all together. Seven times the text of a model with 5 million shells.
inline constexpr std::size_t kMaxUnpackedBytes = std::size_t{4} << 30;

/// Unpacks a file and keeps its stored bytes beside the text; returns an unpacked file as it is. Reads all members of a gzip file and all
/// frames of a zstd file. Stops as soon as it has unpacked more than `max_bytes`, or than max_unpacked of what it has read. Errors, with
/// `path`: damaged, cut off, unpacks to more than that (ErrorKind::over_limit), other data after the packed data; cancelled, without it.
Result<FileBytes> unpack(FileBytes file, const std::filesystem::path& path, const Progress& progress = {},
                         std::size_t max_bytes = kMaxUnpackedBytes);

/// Packs text as `like`, a gzip or zstd file, is packed: gzip with the same name and time in its header and about the same level, zstd
/// with a checksum if `like` has one. Errors: out of memory, cancelled.
Result<std::string> pack(std::span<const std::string_view> text, std::span<const std::byte> like, const Progress& progress = {});

}  // namespace prismesh

// Files packed with gzip or zstd, told by their bytes, whatever they are called.
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

/// By the first bytes.
Packing packing_of(std::span<const std::byte> bytes);

/// The most that `packed_bytes` may unpack to: a file that holds more was made to exhaust memory. No real text packs nearly as well.
constexpr std::size_t most_unpacked(std::size_t packed_bytes) { return 200 * packed_bytes + (std::size_t{256} << 10); }

/// A file with its text unpacked and its stored bytes kept beside it; one that isn't packed comes back as it is. All members of a gzip
/// file and all frames of a zstd file are read. Errors, with `path`: damaged, cut off, unpacks to more than most_unpacked, something else
/// behind the packed data, cancelled.
Result<FileBytes> unpack(FileBytes file, const std::filesystem::path& path, const Progress& progress = {});

/// Text packed in the manner of `like`, which packing_of knows: gzip with the same name and time in its header and about the same effort,
/// zstd with a checksum if that has one. Errors: out of memory, cancelled.
Result<std::string> pack(std::span<const std::string_view> text, std::span<const std::byte> like, const Progress& progress = {});

}  // namespace prismesh

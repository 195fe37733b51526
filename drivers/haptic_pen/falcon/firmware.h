// The firmware file of a Falcon, which the user gives: the device forgets it when it loses power. It is a stream for the boot loader of
// TI's C28x processors (SPRUH18, "SCI boot"): a key, eight reserved words, the entry point, blocks of words, a block of size 0. Nothing
// else in the file tells a good one from a bad one, so its structure is checked before a byte is sent.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"

namespace prismesh::drivers::haptic_pen::falcon {

struct Firmware {
  std::vector<std::byte> bytes;
};

/// Errors: the file can't be read, isn't such a stream, ends too early (with the byte), goes on after its end.
Result<Firmware> read_firmware(const std::filesystem::path& file);
Result<Firmware> parse_firmware(std::span<const std::byte> bytes, const std::string& file);

}  // namespace prismesh::drivers::haptic_pen::falcon

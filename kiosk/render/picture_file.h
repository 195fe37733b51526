// Pictures as files and in memory.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "base/error.h"

namespace prismesh::kiosk::render {

/// Rows from the top, RGB, 8 bits each.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
  const std::uint8_t* at(int x, int y) const { return rgb.data() + (static_cast<std::size_t>(y) * width + x) * 3; }
};

/// The pixels of the bound GL read framebuffer.
Image read_framebuffer(int width, int height);
/// Replaces the file whole or not at all. Errors: not writable.
Result<void> write_png(const std::filesystem::path& path, const Image& image);

}  // namespace prismesh::kiosk::render

// Reads pictures from OpenGL and writes them as PNG files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "base/error.h"

namespace prismesh::kiosk::render {

/// RGB, 8 bits each; rows from the top.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
  const std::uint8_t* at(int x, int y) const { return rgb.data() + (static_cast<std::size_t>(y) * width + x) * 3; }
};

/// Reads the pixels of the bound read framebuffer.
Image read_framebuffer(int width, int height);
/// Writes a PNG file: replaces it whole or not at all. Errors: not writable, no memory.
Result<void> write_png(const std::filesystem::path& path, const Image& image);

}  // namespace prismesh::kiosk::render

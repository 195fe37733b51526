// Pictures as light: a panel's light is linear, a PNG's values aren't.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "base/error.h"

namespace prismesh::viewer {

using Colour = std::array<float, 3>;  ///< red, green, blue; linear, 1 = a white panel

/// Rows from the top.
struct LightImage {
  int width = 0;
  int height = 0;
  std::vector<Colour> pixels;

  LightImage() = default;
  LightImage(int wide, int high, Colour fill = {})
      : width(wide), height(high), pixels(static_cast<std::size_t>(wide) * static_cast<std::size_t>(high), fill) {}
  Colour& at(int x, int y) { return pixels[static_cast<std::size_t>(y) * width + x]; }
  const Colour& at(int x, int y) const { return pixels[static_cast<std::size_t>(y) * width + x]; }
};

/// sRGB (IEC 61966-2-1): 0..1 to linear light and back. Encoding clips values below 0 and above 1.
float linear_from_srgb(float value);
float srgb_from_linear(float light);
/// 0..255, not rounded, for differences as an eye weighs them.
float level(float light);

/// From rows of 8-bit values, three bytes per pixel. `gamma`: of the panel, light = value ^ gamma; 0: sRGB.
LightImage light_of(std::span<const std::uint8_t> rgb, int width, int height, double gamma = 0);
std::vector<std::uint8_t> srgb_bytes(const LightImage& image);

/// Errors, each with the file: can't be read, isn't a picture.
Result<LightImage> read_picture(const std::filesystem::path& path, double gamma = 0);
/// Writes a PNG; replaces the file atomically. Errors: can't be written.
Result<void> write_picture(const std::filesystem::path& path, const LightImage& image);

}  // namespace prismesh::viewer

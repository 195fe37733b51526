#include "tests/viewer/light.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include <stb_image.h>
#include <stb_image_write.h>

#include "base/file.h"

namespace prismesh::viewer {

float linear_from_srgb(float value) { return value <= 0.04045F ? value / 12.92F : std::pow((value + 0.055F) / 1.055F, 2.4F); }

float srgb_from_linear(float light) {
  const float inside = std::clamp(light, 0.0F, 1.0F);
  return inside <= 0.0031308F ? 12.92F * inside : 1.055F * std::pow(inside, 1 / 2.4F) - 0.055F;
}

float level(float light) { return 255 * srgb_from_linear(light); }

LightImage light_of(std::span<const std::uint8_t> rgb, int width, int height, double gamma) {
  std::array<float, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    const float value = static_cast<float>(i) / 255;
    table[i] = gamma > 0 ? std::pow(value, static_cast<float>(gamma)) : linear_from_srgb(value);
  }
  LightImage image(width, height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = {table[rgb[3 * i]], table[rgb[3 * i + 1]], table[rgb[3 * i + 2]]};
  return image;
}

std::vector<std::uint8_t> srgb_bytes(const LightImage& image) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(image.pixels.size() * 3);
  for (const Colour& pixel : image.pixels)
    for (const float light : pixel) bytes.push_back(static_cast<std::uint8_t>(std::lround(level(light))));
  return bytes;
}

Result<LightImage> read_picture(const std::filesystem::path& path, double gamma) {
  const Result<FileBytes> file = read_file(path);
  if (!file) return fail(file.error());
  const std::string_view text = file->text();
  int width = 0, height = 0, channels = 0;
  const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> data(
      stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(text.data()), static_cast<int>(text.size()), &width, &height, &channels, 3),
      &stbi_image_free);
  if (!data) return fail(path.string(), std::string("is no picture that can be read (") + stbi_failure_reason() + ")");
  return light_of({data.get(), static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3}, width, height, gamma);
}

Result<void> write_picture(const std::filesystem::path& path, const LightImage& image) {
  const std::vector<std::uint8_t> rgb = srgb_bytes(image);
  std::string bytes;
  const auto append = [](void* to, void* data, int size) {
    static_cast<std::string*>(to)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
  };
  if (stbi_write_png_to_func(append, &bytes, image.width, image.height, 3, rgb.data(), image.width * 3) == 0)
    return fail(path.string(), "there is no memory to encode the picture");
  const std::array<PendingFile, 1> files{PendingFile{path, {bytes}}};
  return replace_files(files);
}

}  // namespace prismesh::viewer

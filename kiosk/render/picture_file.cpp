#include "kiosk/render/picture_file.h"

#include <array>
#include <string>

#include <GLES3/gl31.h>
#include <stb_image_write.h>

#include "base/file.h"

namespace prismesh::kiosk::render {

Image read_framebuffer(int width, int height) {
  std::vector<std::uint8_t> rgba(static_cast<std::size_t>(width) * height * 4);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  Image image{width, height, std::vector<std::uint8_t>(static_cast<std::size_t>(width) * height * 3)};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const std::size_t from = (static_cast<std::size_t>(height - 1 - y) * width + x) * 4;
      const std::size_t to = (static_cast<std::size_t>(y) * width + x) * 3;
      for (std::size_t channel = 0; channel < 3; ++channel) image.rgb[to + channel] = rgba[from + channel];
    }
  return image;
}

Result<void> write_png(const std::filesystem::path& path, const Image& image) {
  std::string bytes;
  const auto append = [](void* to, void* data, int size) {
    static_cast<std::string*>(to)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
  };
  if (stbi_write_png_to_func(append, &bytes, image.width, image.height, 3, image.rgb.data(), image.width * 3) == 0)
    return fail(path.string(), "there is no memory to encode the picture");
  const std::array<PendingFile, 1> files{PendingFile{path, {bytes}}};
  return replace_files(files);
}

}  // namespace prismesh::kiosk::render

#include "kiosk/render/row_texture.h"

#include <algorithm>
#include <string>

namespace prismesh::kiosk::render {

Result<bool> RowTexture::reserve(std::size_t elements, const char* what) {
  const std::size_t rows = bytes_for(elements, format_) / (kWidth * format_.bytes);
  if (texture_ && rows <= rows_) return false;
  GLint max_size = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &max_size);
  const std::size_t wanted = texture_ ? std::min(std::max(rows, rows_ + rows_ / 4), static_cast<std::size_t>(max_size)) : rows;
  if (static_cast<GLint>(kWidth) > max_size || rows > static_cast<std::size_t>(max_size))
    return fail("OpenGL", "the model's " + std::to_string(elements) + " " + what + " don't fit this graphics driver, which holds " +
                              std::to_string(static_cast<std::size_t>(max_size) * kWidth));
  while (glGetError() != GL_NO_ERROR) {
  }
  rows_ = 0;
  texture_ = gl::Texture::make();
  glBindTexture(GL_TEXTURE_2D, texture_.get());
  glTexStorage2D(GL_TEXTURE_2D, 1, format_.internal, static_cast<GLsizei>(kWidth), static_cast<GLsizei>(wanted));
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  if (glGetError() != GL_NO_ERROR)
    return fail("OpenGL", "there is no graphics memory for the model's " + std::to_string(elements) + " " + what);
  rows_ = wanted;
  return true;
}

void RowTexture::upload_row(std::size_t row, std::span<const std::byte> texels) {
  if (texels.empty()) return;
  bytes_uploaded_ += texels.size();
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glBindTexture(GL_TEXTURE_2D, texture_.get());
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, static_cast<GLint>(row), static_cast<GLsizei>(texels.size() / format_.bytes), 1, format_.format,
                  format_.type, texels.data());
}

void RowTexture::upload(std::span<const std::byte> texels) {
  const std::size_t row_bytes = kWidth * format_.bytes;
  for (std::size_t row = 0; row * row_bytes < texels.size(); ++row)
    upload_row(row, texels.subspan(row * row_bytes, std::min(row_bytes, texels.size() - row * row_bytes)));
}

void RowTexture::bind(unsigned unit) const {
  glActiveTexture(GL_TEXTURE0 + unit);
  glBindTexture(GL_TEXTURE_2D, texture_.get());
}

}  // namespace prismesh::kiosk::render

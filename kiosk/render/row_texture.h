// Holds an array of the model as a texture with one row for each chunk, so that a changed chunk is one upload.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include "kiosk/render/gl.h"
#include "mesh/model/chunked_array.h"

namespace prismesh::kiosk::render {

/// Format of one element.
struct TexelFormat {
  GLenum internal;
  GLenum format;
  GLenum type;
  std::size_t bytes;
};
inline constexpr TexelFormat kPositionTexel{GL_RGBA32F, GL_RGBA, GL_FLOAT, 16};
inline constexpr TexelFormat kFourIndices{GL_RGBA32UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT, 16};
inline constexpr TexelFormat kTwoIndices{GL_RG32UI, GL_RG_INTEGER, GL_UNSIGNED_INT, 8};
inline constexpr TexelFormat kOneIndex{GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, 4};

/// Element i is the texel (i & 4095, i >> 12).
class RowTexture {
 public:
  static constexpr std::size_t kWidth = mesh::kChunkSize;

  explicit RowTexture(const TexelFormat& format) : format_(format) {}

  /// Allocates space for `elements`. True if the texture is new and its content undefined. `what` names the array in errors. Errors: larger
  /// than the GPU allows, no graphics memory.
  Result<bool> reserve(std::size_t elements, const char* what);
  /// Replaces the first elements of a row.
  void upload_row(std::size_t row, std::span<const std::byte> texels);
  /// Replaces everything from the start.
  void upload(std::span<const std::byte> texels);
  void bind(unsigned unit) const;
  /// Over the texture's life.
  std::size_t bytes_uploaded() const { return bytes_uploaded_; }
  std::size_t bytes_held() const { return rows_ * kWidth * format_.bytes; }
  /// Bytes that a new texture for so many elements holds.
  static std::size_t bytes_for(std::size_t elements, const TexelFormat& format) {
    return std::max<std::size_t>(1, (elements + kWidth - 1) / kWidth) * kWidth * format.bytes;
  }

 private:
  TexelFormat format_;
  gl::Texture texture_;
  std::size_t rows_ = 0;
  std::size_t bytes_uploaded_ = 0;
};

}  // namespace prismesh::kiosk::render

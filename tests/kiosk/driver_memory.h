// What a graphics driver itself says that it holds: independent of what the renderer counts.
#pragma once

#include <cstddef>
#include <stdexcept>

#include <GLES3/gl31.h>

namespace prismesh::kiosk::render {

inline std::size_t texel_bytes_of(GLint format) {
  switch (format) {
    case GL_R8: return 1;
    case GL_R32UI:
    case GL_RGBA8:
    case GL_DEPTH_COMPONENT24:
    case GL_DEPTH24_STENCIL8: return 4;
    case GL_RG32UI:
    case GL_RG32F: return 8;
    case GL_RGBA32F:
    case GL_RGBA32UI: return 16;
    default: throw std::runtime_error("an unknown texture format");
  }
}

/// Bytes of all textures, renderbuffers and buffers of the current context.
inline std::size_t bytes_in_driver() {
  std::size_t bytes = 0;
  GLint width = 0, height = 0, samples = 0, format = 0;
  for (GLuint name = 1; name < 2000; ++name) {
    if (glIsTexture(name)) {
      glBindTexture(GL_TEXTURE_2D, name);
      glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_WIDTH, &width);
      glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_HEIGHT, &height);
      glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_INTERNAL_FORMAT, &format);
      if (width > 0 && height > 0) bytes += static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * texel_bytes_of(format);
    }
    if (glIsRenderbuffer(name)) {
      glBindRenderbuffer(GL_RENDERBUFFER, name);
      glGetRenderbufferParameteriv(GL_RENDERBUFFER, GL_RENDERBUFFER_WIDTH, &width);
      glGetRenderbufferParameteriv(GL_RENDERBUFFER, GL_RENDERBUFFER_HEIGHT, &height);
      glGetRenderbufferParameteriv(GL_RENDERBUFFER, GL_RENDERBUFFER_SAMPLES, &samples);
      glGetRenderbufferParameteriv(GL_RENDERBUFFER, GL_RENDERBUFFER_INTERNAL_FORMAT, &format);
      bytes += static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * static_cast<std::size_t>(samples > 1 ? samples : 1) *
               texel_bytes_of(format);
    }
    if (glIsBuffer(name)) {
      GLint64 size = 0;
      glBindBuffer(GL_COPY_WRITE_BUFFER, name);
      glGetBufferParameteri64v(GL_COPY_WRITE_BUFFER, GL_BUFFER_SIZE, &size);
      bytes += static_cast<std::size_t>(size);
    }
  }
  return bytes;
}

}  // namespace prismesh::kiosk::render

#include "kiosk/render/offscreen.h"

#include <string>

#include "kiosk/render/gl.h"

namespace prismesh::kiosk::render {

struct Offscreen::Impl {
  gl::Framebuffer framebuffer;
  gl::Texture colour;
  int width = 0;
  int height = 0;
};

Offscreen::Offscreen(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Offscreen::Offscreen(Offscreen&&) noexcept = default;
Offscreen& Offscreen::operator=(Offscreen&&) noexcept = default;
Offscreen::~Offscreen() = default;

Result<Offscreen> Offscreen::create(int width, int height) {
  GLint max_size = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &max_size);
  if (width < 1 || height < 1 || width > max_size || height > max_size)
    return fail("OpenGL", "a picture of " + std::to_string(width) + "x" + std::to_string(height) +
                              " pixels can't be drawn here; each side may be 1 to " + std::to_string(max_size));
  auto impl = std::make_unique<Impl>();
  impl->width = width;
  impl->height = height;
  impl->colour = gl::Texture::make();
  glBindTexture(GL_TEXTURE_2D, impl->colour.get());
  glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, width, height);
  impl->framebuffer = gl::Framebuffer::make();
  glBindFramebuffer(GL_FRAMEBUFFER, impl->framebuffer.get());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, impl->colour.get(), 0);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    return fail("OpenGL",
                "there is no graphics memory for a picture of " + std::to_string(width) + "x" + std::to_string(height) + " pixels");
  return Offscreen(std::move(impl));
}

unsigned Offscreen::framebuffer() const { return impl_->framebuffer.get(); }

Image Offscreen::read() const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, impl_->framebuffer.get());
  return read_framebuffer(impl_->width, impl_->height);
}

}  // namespace prismesh::kiosk::render

#include "kiosk/render/offscreen.h"

#include <string>

#include "kiosk/render/gl.h"

namespace prismesh::kiosk::render {

struct Offscreen::State {
  gl::Framebuffer framebuffer;
  gl::Texture colour;
  int width = 0;
  int height = 0;
};

Offscreen::Offscreen(std::unique_ptr<State> state) : state_(std::move(state)) {}
Offscreen::Offscreen(Offscreen&&) noexcept = default;
Offscreen& Offscreen::operator=(Offscreen&&) noexcept = default;
Offscreen::~Offscreen() = default;

Result<Offscreen> Offscreen::create(int width, int height) {
  GLint largest = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
  if (width < 1 || height < 1 || width > largest || height > largest)
    return fail("OpenGL", "a picture of " + std::to_string(width) + "x" + std::to_string(height) +
                              " pixels can't be drawn here; each side may be 1 to " + std::to_string(largest));
  auto state = std::make_unique<State>();
  state->width = width;
  state->height = height;
  state->colour = gl::Texture::make();
  glBindTexture(GL_TEXTURE_2D, state->colour.get());
  glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, width, height);
  state->framebuffer = gl::Framebuffer::make();
  glBindFramebuffer(GL_FRAMEBUFFER, state->framebuffer.get());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, state->colour.get(), 0);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    return fail("OpenGL",
                "there is no graphics memory for a picture of " + std::to_string(width) + "x" + std::to_string(height) + " pixels");
  return Offscreen(std::move(state));
}

unsigned Offscreen::framebuffer() const { return state_->framebuffer.get(); }

Image Offscreen::read() const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, state_->framebuffer.get());
  return read_framebuffer(state_->width, state_->height);
}

}  // namespace prismesh::kiosk::render

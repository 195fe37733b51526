#include "kiosk/render/eye_images.h"

#include <string>
#include <utility>

namespace prismesh::kiosk::render {

Result<void> EyeImages::resize(int width, int height, int samples) {
  if (width == width_ && height == height_ && samples == samples_) return {};
  GLint max_size = 0;
  glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &max_size);
  if (width < 1 || height < 1 || width > max_size || height > max_size)
    return fail("OpenGL", "an eye's image of " + std::to_string(width) + "x" + std::to_string(height) +
                              " pixels can't be drawn here; each side may be 1 to " + std::to_string(max_size));
  *this = EyeImages();
  width_ = width;
  height_ = height;
  samples_ = samples;
  bool complete = make_scene();
  for (Flat& flat : flat_) complete = make_flat(flat) && complete;
  if (complete) return {};
  *this = EyeImages();
  return fail("OpenGL",
              "there is no graphics memory for the eyes' images of " + std::to_string(width) + "x" + std::to_string(height) + " pixels");
}

bool EyeImages::make_scene() {
  scene_ = gl::Framebuffer::make();
  scene_colour_ = gl::Renderbuffer::make();
  depth_ = gl::Renderbuffer::make();
  const GLsizei multi = samples_ > 1 ? samples_ : 0;
  glBindRenderbuffer(GL_RENDERBUFFER, scene_colour_.get());
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, multi, GL_RGBA8, width_, height_);
  glBindRenderbuffer(GL_RENDERBUFFER, depth_.get());
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, multi, GL_DEPTH24_STENCIL8, width_, height_);
  glBindFramebuffer(GL_FRAMEBUFFER, scene_.get());
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, scene_colour_.get());
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER, depth_.get());
  return glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
}

bool EyeImages::make_flat(Flat& flat) const {
  flat.colour = gl::Texture::make();
  glBindTexture(GL_TEXTURE_2D, flat.colour.get());
  glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, width_, height_);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  flat.framebuffer = gl::Framebuffer::make();
  glBindFramebuffer(GL_FRAMEBUFFER, flat.framebuffer.get());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, flat.colour.get(), 0);
  const bool complete = glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
  return make_resolved(flat.kept, flat.kept_colour) && complete;
}

bool EyeImages::make_resolved(gl::Framebuffer& framebuffer, gl::Renderbuffer& colour) const {
  colour = gl::Renderbuffer::make();
  glBindRenderbuffer(GL_RENDERBUFFER, colour.get());
  glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width_, height_);
  framebuffer = gl::Framebuffer::make();
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.get());
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour.get());
  return glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
}

std::size_t EyeImages::bytes_of_pixel(int samples, bool aside) {
  const std::size_t scene = static_cast<std::size_t>(samples) * 8;  // colour, and depth with stencil
  const std::size_t flat = 4 + 4 + (aside ? 4 : 0);
  return scene + 2 * flat;
}

std::size_t EyeImages::bytes_held() const {
  if (!scene_) return 0;
  const std::size_t pixels = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  std::size_t bytes = pixels * bytes_of_pixel(samples_, false);
  for (const Flat& flat : flat_) bytes += flat.aside ? pixels * 4 : 0;
  return bytes;
}

void EyeImages::bind_scene() const {
  glBindFramebuffer(GL_FRAMEBUFFER, scene_.get());
  glViewport(0, 0, width_, height_);
}

void EyeImages::copy(const gl::Framebuffer& from, const gl::Framebuffer& to) const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, from.get());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, to.get());
  glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

void EyeImages::keep_scene(int eye) const { copy(scene_, flat_[static_cast<std::size_t>(eye)].kept); }

bool EyeImages::put_aside(int eye) {
  Flat& flat = flat_[static_cast<std::size_t>(eye)];
  if (!flat.aside && !make_resolved(flat.aside, flat.aside_colour)) return false;
  copy(scene_, flat.aside);
  return true;
}

void EyeImages::keep_aside() {
  for (Flat& flat : flat_) {
    if (!flat.aside) continue;
    std::swap(flat.kept, flat.aside);
    std::swap(flat.kept_colour, flat.aside_colour);
  }
}

void EyeImages::bind_flat(int eye) const {
  const Flat& flat = flat_[static_cast<std::size_t>(eye)];
  copy(flat.kept, flat.framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, flat.framebuffer.get());
  glViewport(0, 0, width_, height_);
}

void EyeImages::bind_texture(int eye, unsigned unit) const {
  glActiveTexture(GL_TEXTURE0 + unit);
  glBindTexture(GL_TEXTURE_2D, flat_[static_cast<std::size_t>(eye)].colour.get());
}

}  // namespace prismesh::kiosk::render

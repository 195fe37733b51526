// The images that the eyes' pictures are drawn into before they are woven.
#pragma once

#include <array>

#include "kiosk/render/gl.h"

namespace prismesh::kiosk::render {

class EyeImages {
 public:
  /// Images of width x height pixels; nothing happens if they are there already. Errors: too large, no memory.
  Result<void> resize(int width, int height, int samples);

  /// Binds what an eye's scene is drawn into: colour and depth, multisampled if asked for.
  void bind_scene() const;
  /// The scene is that of `eye` (0 left or only, 1 right) and done: keeps it, resolved.
  void keep_scene(int eye) const;
  /// Binds the plain image of an eye, a copy of the scene kept for it, for what is drawn flat on top.
  void bind_flat(int eye) const;
  void bind_texture(int eye, unsigned unit) const;
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  struct Flat {
    gl::Framebuffer framebuffer;
    gl::Texture colour;
    gl::Framebuffer kept;
    gl::Renderbuffer kept_colour;
  };
  void copy(const gl::Framebuffer& from, const gl::Framebuffer& to) const;

  int width_ = 0;
  int height_ = 0;
  int samples_ = 0;
  gl::Framebuffer scene_;  ///< shared by both eyes: one is drawn after the other
  gl::Renderbuffer scene_colour_;
  gl::Renderbuffer depth_;
  std::array<Flat, 2> flat_;
};

}  // namespace prismesh::kiosk::render

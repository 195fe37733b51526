// Framebuffers for the eyes' images, which are drawn before they are woven into the display's picture.
#pragma once

#include <array>
#include <cstddef>

#include "kiosk/render/gl.h"

namespace prismesh::kiosk::render {

class EyeImages {
 public:
  /// Allocates images of width x height pixels; keeps those of the same size. Errors: larger than the GPU allows, no graphics memory.
  Result<void> resize(int width, int height, int samples);

  /// Binds the scene's framebuffer with colour and depth, multisampled if `samples` > 1. Both eyes use it in turn.
  void bind_scene() const;
  /// Resolves the finished scene and keeps it as the image of `eye` (0 left or only, 1 right).
  void keep_scene(int eye) const;
  /// Resolves the finished scene and puts it aside as the next image of `eye`. Returns false if there is no graphics memory.
  bool put_aside(int eye);
  /// Keeps the images that were put aside.
  void keep_aside();
  /// Copies the kept scene of an eye into its flat image and binds that, to draw what lies in the screen's plane.
  void bind_flat(int eye) const;
  /// Binds the flat image of an eye as a texture.
  void bind_texture(int eye, unsigned unit) const;
  /// Bytes on the graphics card for a pixel of the images. `aside`: with those that are put aside.
  static std::size_t bytes_of_pixel(int samples, bool aside);
  std::size_t bytes_held() const;
  int samples() const { return samples_; }
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  struct Flat {
    gl::Framebuffer framebuffer;
    gl::Texture colour;
    gl::Framebuffer kept;
    gl::Renderbuffer kept_colour;
    gl::Framebuffer aside;  ///< made when it is needed first
    gl::Renderbuffer aside_colour;
  };
  // Allocate for the current size. False: no graphics memory.
  bool make_scene();
  bool make_flat(Flat& flat) const;
  bool make_resolved(gl::Framebuffer& framebuffer, gl::Renderbuffer& colour) const;
  void copy(const gl::Framebuffer& from, const gl::Framebuffer& to) const;

  int width_ = 0;
  int height_ = 0;
  int samples_ = 0;
  gl::Framebuffer scene_;  ///< shared by both eyes, which are drawn in turn
  gl::Renderbuffer scene_colour_;
  gl::Renderbuffer depth_;
  std::array<Flat, 2> flat_;
};

}  // namespace prismesh::kiosk::render

// Makes one picture of the eyes' images: the last step, after which nothing may touch a pixel.
#pragma once

#include "kiosk/render/composition.h"
#include "kiosk/render/eye_images.h"
#include "kiosk/render/gl.h"
#include "kiosk/render/shaders.h"

namespace prismesh::kiosk::render {

class WeavePass {
 public:
  explicit WeavePass(const Shaders& shaders) : shaders_(shaders), no_attributes_(gl::VertexArray::make()) {}

  /// Into a framebuffer of width x height pixels (0: the window's).
  void draw(const Composition& composition, const EyeImages& images, unsigned framebuffer, int width, int height);

 private:
  void upload(const drivers::display::PhaseMap& phases);

  const Shaders& shaders_;
  gl::VertexArray no_attributes_;
  gl::Texture phases_;
  int columns_ = 0, rows_ = 0;  ///< of the texture
};

}  // namespace prismesh::kiosk::render

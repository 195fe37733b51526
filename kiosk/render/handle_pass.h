// Draws the handle: solid where it is visible, dimmed where something hides it, so that it can always be picked.
#pragma once

#include "kiosk/render/frame.h"
#include "kiosk/render/handle_mesh.h"
#include "kiosk/render/shaders.h"

namespace prismesh::kiosk::render {

class HandlePass {
 public:
  explicit HandlePass(const Shaders& shaders);

  /// Draws into the bound framebuffer, after the model. Leaves the depth test on (GL_LEQUAL) and blending off.
  void draw(const std::vector<HandlePiece>& pieces, const EyeView& eye) const;

  std::size_t bytes_held() const { return gl::bytes_held(buffer_); }

 private:
  const Shaders& shaders_;
  gl::VertexArray array_;
  gl::Buffer buffer_;
};

}  // namespace prismesh::kiosk::render

// Draws what lies in the screen's plane over the finished scene: rubber band, lasso and the picture's overlay.
#pragma once

#include "kiosk/render/frame.h"
#include "kiosk/render/shaders.h"

namespace prismesh::kiosk::render {

class FlatPass {
 public:
  explicit FlatPass(const Shaders& shaders);

  /// Draws into the bound framebuffer. The viewport must be set.
  void draw(const Picture& picture, const EyeView& eye) const;

  std::size_t bytes_held() const { return gl::bytes_held(segment_buffer_); }

 private:
  void draw_rectangle(const PixelRect& band, const EyeImage& image) const;
  void draw_lasso(const std::vector<Eigen::Vector2d>& corners, const EyeImage& image) const;

  const Shaders& shaders_;
  gl::VertexArray no_attributes_;
  gl::VertexArray segments_;
  gl::Buffer segment_buffer_;
};

}  // namespace prismesh::kiosk::render

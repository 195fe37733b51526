// Draws the shadows of what is dragged, or else selected, on the planes of shadows.h: soft, darker than the ground.
#pragma once

#include <array>

#include "kiosk/render/frame.h"
#include "kiosk/render/shaders.h"
#include "kiosk/render/shadows.h"

namespace prismesh::kiosk::render {

class ShadowPass {
 public:
  explicit ShadowPass(const Shaders& shaders);

  /// Casts the shadows, once for all images of a scene. Changes framebuffer and viewport. Errors: no graphics memory.
  Result<void> cast(ModelLayer& model, const stereo::View& view);
  /// The planes with what was cast on them, into the bound framebuffer, after the shells. Leaves blending on and depth unwritten.
  void draw(const ModelLayer& model, const Frame& frame) const;

 private:
  struct Cast {
    ShadowPlane plane;
    gl::Texture mask;
    gl::Framebuffer framebuffer;
  };
  const Shaders& shaders_;
  gl::VertexArray no_attributes_;
  std::array<Cast, 3> casts_;
  std::size_t count_ = 0;
};

}  // namespace prismesh::kiosk::render

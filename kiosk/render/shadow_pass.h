// Draws soft shadows of what is dragged, or else selected, on the planes of shadows.h.
#pragma once

#include <array>

#include "kiosk/render/frame.h"
#include "kiosk/render/shaders.h"
#include "kiosk/render/shadows.h"

namespace prismesh::kiosk::render {

class ShadowPass {
 public:
  explicit ShadowPass(const Shaders& shaders);

  /// Draws the shadows into one texture for each plane. Call once before all images of a scene. Changes framebuffer and viewport. Errors:
  /// no graphics memory.
  Result<void> cast(ModelLayer& model, const stereo::View& view);
  /// Draws the planes with their shadows into the bound framebuffer, after the shells. Leaves blending and the depth mask on.
  void draw(const ModelLayer& model, const Frame& frame) const;

  std::size_t bytes_held() const;
  static std::size_t max_bytes();

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

// Draws the selected nodes: white octahedra of constant size on the screen; those behind something show through, dimmed.
#pragma once

#include <array>
#include <cstdint>

#include "kiosk/render/frame.h"
#include "kiosk/render/shaders.h"

namespace prismesh::kiosk::render {

class NodePass {
 public:
  explicit NodePass(const Shaders& shaders);

  /// Into the bound framebuffer, after what may hide them; positions are bound. Costs the chunks on the processor. Leaves the depth test
  /// on (GL_LEQUAL) and depth written.
  void draw(const ModelLayer& model, const Frame& frame) const;

 private:
  /// A chunk's worth of one solid as indices: the corners of the nth count from n times their number.
  struct Solid {
    const gl::Program& program;
    gl::VertexArray array;
    gl::Buffer indices;
    int indices_each = 0;
  };
  template <std::size_t N>
  static Solid make_solid(const gl::Program& program, int corners, const std::array<std::uint8_t, N>& indices);

  Solid octahedra_;
  Solid squares_;
};

}  // namespace prismesh::kiosk::render

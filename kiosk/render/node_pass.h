// Draws the selected nodes as white octahedra of constant size on the screen. Nodes behind a surface are drawn too, dimmed.
#pragma once

#include <array>
#include <cstdint>

#include "kiosk/render/frame.h"
#include "kiosk/render/shaders.h"

namespace prismesh::kiosk::render {

class NodePass {
 public:
  explicit NodePass(const Shaders& shaders);

  /// Draws into the bound framebuffer, after what may hide the nodes. The model's positions must be bound. Time on the processor is
  /// proportional to the number of chunks. Leaves the depth test on (GL_LEQUAL) and the depth mask on.
  void draw(const ModelLayer& model, const Frame& frame) const;

  std::size_t bytes_held() const { return gl::bytes_held(octahedra_.indices) + gl::bytes_held(squares_.indices); }

 private:
  /// Indices of one solid for each node of a chunk. Corners of node n start at n * the solid's number of corners.
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

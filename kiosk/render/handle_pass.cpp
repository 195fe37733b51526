#include "kiosk/render/handle_pass.h"

#include <cstddef>

namespace prismesh::kiosk::render {

namespace {
constexpr float kHandleHiddenAlpha = 0.35F;  ///< of pieces behind a surface
}

HandlePass::HandlePass(const Shaders& shaders) : shaders_(shaders), array_(gl::VertexArray::make()), buffer_(gl::Buffer::make()) {
  glBindVertexArray(array_.get());
  glBindBuffer(GL_ARRAY_BUFFER, buffer_.get());
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(HandleVertex), nullptr);
  // NOLINTNEXTLINE(performance-no-int-to-ptr): OpenGL passes offsets as pointers
  glVertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, sizeof(HandleVertex), reinterpret_cast<const void*>(offsetof(HandleVertex, outward)));
  glEnableVertexAttribArray(0);
  glEnableVertexAttribArray(1);
  glBindVertexArray(0);
}

void HandlePass::draw(const std::vector<HandlePiece>& pieces, const EyeView& eye) const {
  const gl::Program& program = shaders_.handle;
  program.use();
  program.set("clip_from_screen", Eigen::Matrix4f(eye.clip_from_screen.cast<float>()));
  glBindVertexArray(array_.get());
  glBindBuffer(GL_ARRAY_BUFFER, buffer_.get());
  glCullFace(GL_BACK);
  glFrontFace(GL_CCW);
  blend_by_alpha();
  for (const HandlePiece& piece : pieces) {
    const auto count = static_cast<GLsizei>(piece.triangles.size());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(piece.triangles.size() * sizeof(HandleVertex)), piece.triangles.data(),
                 GL_STREAM_DRAW);
    const Colour& colour = piece.active ? kActiveColour : kSelectedColour;
    if (piece.sheet)
      glDisable(GL_CULL_FACE);
    else
      glEnable(GL_CULL_FACE);
    program.set("ink", colour.x(), colour.y(), colour.z(), kHandleHiddenAlpha * piece.alpha);
    glDepthMask(GL_FALSE);
    glDepthFunc(GL_GREATER);
    glDrawArrays(GL_TRIANGLES, 0, count);
    program.set("ink", colour.x(), colour.y(), colour.z(), piece.alpha);
    glDepthMask(piece.sheet ? GL_FALSE : GL_TRUE);
    glDepthFunc(GL_LEQUAL);
    glDrawArrays(GL_TRIANGLES, 0, count);
  }
  glDepthMask(GL_TRUE);
  glDisable(GL_CULL_FACE);
  glDisable(GL_BLEND);
}

}  // namespace prismesh::kiosk::render

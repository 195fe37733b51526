#include "kiosk/panels/gui_renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include <GLES3/gl31.h>
#include <imgui.h>

namespace prismesh::kiosk::panels {
namespace {

constexpr const char* kVertexShader = R"(#version 310 es
layout(location = 0) in vec2 position;
layout(location = 1) in vec2 texture_position;
layout(location = 2) in vec4 colour;
uniform vec4 scale_and_offset;
out vec2 uv;
out vec4 tint;
void main() {
  uv = texture_position;
  tint = colour;
  gl_Position = vec4(position * scale_and_offset.xy + scale_and_offset.zw, 0.0, 1.0);
}
)";

constexpr const char* kFragmentShader = R"(#version 310 es
precision mediump float;
uniform sampler2D atlas;
in vec2 uv;
in vec4 tint;
out vec4 colour;
void main() { colour = vec4(tint.rgb, tint.a * texture(atlas, uv).r); }
)";

Result<GLuint> compile(GLenum kind, const char* source) {
  const GLuint shader = glCreateShader(kind);
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  GLint compiled = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (compiled != 0) return shader;
  std::array<char, 1024> log{};
  glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
  glDeleteShader(shader);
  return fail("", std::string("the graphics driver refuses the panels' shader: ") + log.data());
}

/// The GL state that drawing changes, put back at the end.
class SavedState {
 public:
  SavedState() {
    glGetIntegerv(GL_CURRENT_PROGRAM, &program_);
    glGetIntegerv(GL_VERTEX_ARRAY_BINDING, &vertex_array_);
    glGetIntegerv(GL_ARRAY_BUFFER_BINDING, &array_buffer_);
    glGetIntegerv(GL_ACTIVE_TEXTURE, &unit_);
    glActiveTexture(GL_TEXTURE0);
    glGetIntegerv(GL_TEXTURE_BINDING_2D, &texture_);
    glGetIntegerv(GL_VIEWPORT, viewport_.data());
    depth_ = glIsEnabled(GL_DEPTH_TEST);
    cull_ = glIsEnabled(GL_CULL_FACE);
    blend_ = glIsEnabled(GL_BLEND);
    scissor_ = glIsEnabled(GL_SCISSOR_TEST);
  }
  ~SavedState() {
    set(GL_DEPTH_TEST, depth_);
    set(GL_CULL_FACE, cull_);
    set(GL_BLEND, blend_);
    set(GL_SCISSOR_TEST, scissor_);
    glViewport(viewport_[0], viewport_[1], viewport_[2], viewport_[3]);
    glBindTexture(GL_TEXTURE_2D, static_cast<GLuint>(texture_));
    glActiveTexture(static_cast<GLenum>(unit_));
    glBindVertexArray(static_cast<GLuint>(vertex_array_));
    glBindBuffer(GL_ARRAY_BUFFER, static_cast<GLuint>(array_buffer_));
    glUseProgram(static_cast<GLuint>(program_));
  }
  SavedState(const SavedState&) = delete;
  SavedState& operator=(const SavedState&) = delete;

 private:
  static void set(GLenum capability, GLboolean on) {
    if (on != 0)
      glEnable(capability);
    else
      glDisable(capability);
  }
  GLint program_ = 0, vertex_array_ = 0, array_buffer_ = 0, unit_ = 0, texture_ = 0;
  std::array<GLint, 4> viewport_{};
  GLboolean depth_ = 0, cull_ = 0, blend_ = 0, scissor_ = 0;
};

}  // namespace

struct GuiRenderer::State {
  GLuint program = 0;
  GLint scale_and_offset = -1;
  GLuint vertex_array = 0;
  GLuint vertices = 0;
  GLuint indices = 0;
  GLuint atlas = 0;

  State() = default;
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() {
    glDeleteProgram(program);
    glDeleteVertexArrays(1, &vertex_array);
    glDeleteBuffers(1, &vertices);
    glDeleteBuffers(1, &indices);
    glDeleteTextures(1, &atlas);
  }
};

GuiRenderer::GuiRenderer(std::unique_ptr<State> state) : state_(std::move(state)) {}
GuiRenderer::GuiRenderer(GuiRenderer&&) noexcept = default;
GuiRenderer& GuiRenderer::operator=(GuiRenderer&&) noexcept = default;
GuiRenderer::~GuiRenderer() = default;

Result<GuiRenderer> GuiRenderer::create() {
  auto state = std::make_unique<State>();
  const Result<GLuint> vertex = compile(GL_VERTEX_SHADER, kVertexShader);
  if (!vertex) return fail(vertex.error());
  const Result<GLuint> fragment = compile(GL_FRAGMENT_SHADER, kFragmentShader);
  if (!fragment) return fail(fragment.error());
  state->program = glCreateProgram();
  glAttachShader(state->program, *vertex);
  glAttachShader(state->program, *fragment);
  glLinkProgram(state->program);
  glDeleteShader(*vertex);
  glDeleteShader(*fragment);
  state->scale_and_offset = glGetUniformLocation(state->program, "scale_and_offset");

  glGenVertexArrays(1, &state->vertex_array);
  glGenBuffers(1, &state->vertices);
  glGenBuffers(1, &state->indices);
  const SavedState saved;
  glBindVertexArray(state->vertex_array);
  glBindBuffer(GL_ARRAY_BUFFER, state->vertices);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, state->indices);
  const auto at = [](std::size_t offset) { return reinterpret_cast<const void*>(offset); };
  constexpr GLsizei kStride = sizeof(ImDrawVert);
  for (GLuint i = 0; i < 3; ++i) glEnableVertexAttribArray(i);
  glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, kStride, at(offsetof(ImDrawVert, pos)));
  glVertexAttribPointer(1, 2, GL_FLOAT, GL_FALSE, kStride, at(offsetof(ImDrawVert, uv)));
  glVertexAttribPointer(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, kStride, at(offsetof(ImDrawVert, col)));

  GuiRenderer renderer(std::move(state));
  renderer.upload_fonts();
  return renderer;
}

void GuiRenderer::upload_fonts() {
  unsigned char* pixels = nullptr;
  int width = 0, height = 0;
  ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
  fonts.GetTexDataAsAlpha8(&pixels, &width, &height);
  const SavedState saved;
  if (state_->atlas == 0) glGenTextures(1, &state_->atlas);
  glBindTexture(GL_TEXTURE_2D, state_->atlas);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_R8, width, height, 0, GL_RED, GL_UNSIGNED_BYTE, pixels);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  fonts.TexID = reinterpret_cast<ImTextureID>(static_cast<std::intptr_t>(state_->atlas));
}

void GuiRenderer::draw(const ImDrawData& data, display::PixelSize target, display::PixelSize picture, double shift_x) const {
  const ImVec2 size(static_cast<float>(picture.width), static_cast<float>(picture.height)), origin = data.DisplayPos;
  if (size.x <= 0 || size.y <= 0 || target.width <= 0 || target.height <= 0) return;
  const SavedState saved;
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glEnable(GL_BLEND);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glEnable(GL_SCISSOR_TEST);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glViewport(0, 0, target.width, target.height);
  glUseProgram(state_->program);
  glUniform4f(state_->scale_and_offset, 2.0f / size.x, -2.0f / size.y, -1.0f - 2.0f * origin.x / size.x + static_cast<float>(shift_x),
              1.0f + 2.0f * origin.y / size.y);
  glBindVertexArray(state_->vertex_array);
  glBindBuffer(GL_ARRAY_BUFFER, state_->vertices);
  glBindTexture(GL_TEXTURE_2D, state_->atlas);

  const float to_x = static_cast<float>(target.width) / size.x, to_y = static_cast<float>(target.height) / size.y;
  for (int l = 0; l < data.CmdListsCount; ++l) {
    const ImDrawList& list = *data.CmdLists[l];
    glBufferData(GL_ARRAY_BUFFER, list.VtxBuffer.size_in_bytes(), list.VtxBuffer.Data, GL_STREAM_DRAW);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, list.IdxBuffer.size_in_bytes(), list.IdxBuffer.Data, GL_STREAM_DRAW);
    for (const ImDrawCmd& command : list.CmdBuffer) {
      const int left = std::max(0, static_cast<int>(std::floor((command.ClipRect.x - origin.x) * to_x)));
      const int right = std::min(target.width, static_cast<int>(std::ceil((command.ClipRect.z - origin.x) * to_x)));
      const int top = std::max(0, static_cast<int>(std::floor((command.ClipRect.y - origin.y) * to_y)));
      const int bottom = std::min(target.height, static_cast<int>(std::ceil((command.ClipRect.w - origin.y) * to_y)));
      if (right <= left || bottom <= top || command.ElemCount == 0) continue;
      glScissor(left, target.height - bottom, right - left, bottom - top);
      glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(command.ElemCount), sizeof(ImDrawIdx) == 2 ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT,
                     reinterpret_cast<const void*>(static_cast<std::size_t>(command.IdxOffset) * sizeof(ImDrawIdx)));
    }
  }
}

}  // namespace prismesh::kiosk::panels

#include "kiosk/panels/gui_renderer.h"

#include <array>
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
uniform vec3 to_x, to_y;
out vec2 uv;
out vec4 tint;
out vec2 place;
void main() {
  uv = texture_position;
  tint = colour;
  place = position;
  vec3 at = vec3(position, 1.0);
  gl_Position = vec4(dot(to_x, at), dot(to_y, at), 0.0, 1.0);
}
)";

constexpr const char* kFragmentShader = R"(#version 310 es
precision mediump float;
uniform sampler2D atlas;
uniform highp vec4 clip;
in highp vec2 uv;
in vec4 tint;
in highp vec2 place;
out vec4 colour;
void main() {
  // A scissor can't follow an image that is sheared.
  if (any(lessThan(place, clip.xy)) || any(greaterThan(place, clip.zw))) discard;
  colour = vec4(tint.rgb, tint.a * texture(atlas, uv).r);
}
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

struct GuiRenderer::Impl {
  GLuint program = 0;
  GLint to_x = -1, to_y = -1, clip = -1;
  GLuint vertex_array = 0;
  GLuint vertices = 0;
  GLuint indices = 0;
  GLuint atlas = 0;

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    glDeleteProgram(program);
    glDeleteVertexArrays(1, &vertex_array);
    glDeleteBuffers(1, &vertices);
    glDeleteBuffers(1, &indices);
    glDeleteTextures(1, &atlas);
  }
};

GuiRenderer::GuiRenderer(std::unique_ptr<Impl> state) : impl_(std::move(state)) {}
GuiRenderer::GuiRenderer(GuiRenderer&&) noexcept = default;
GuiRenderer& GuiRenderer::operator=(GuiRenderer&&) noexcept = default;
GuiRenderer::~GuiRenderer() = default;

Result<GuiRenderer> GuiRenderer::create() {
  auto state = std::make_unique<Impl>();
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
  state->to_x = glGetUniformLocation(state->program, "to_x");
  state->to_y = glGetUniformLocation(state->program, "to_y");
  state->clip = glGetUniformLocation(state->program, "clip");

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
  if (impl_->atlas == 0) glGenTextures(1, &impl_->atlas);
  glBindTexture(GL_TEXTURE_2D, impl_->atlas);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_R8, width, height, 0, GL_RED, GL_UNSIGNED_BYTE, pixels);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  fonts.TexID = reinterpret_cast<ImTextureID>(static_cast<std::intptr_t>(impl_->atlas));
}

void GuiRenderer::draw(const ImDrawData& data, display::PixelSize target, const PictureMap& from_picture) const {
  if (target.width <= 0 || target.height <= 0) return;
  const SavedState saved;
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glDisable(GL_SCISSOR_TEST);
  glEnable(GL_BLEND);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glViewport(0, 0, target.width, target.height);
  glUseProgram(impl_->program);
  const Eigen::Vector3d origin(data.DisplayPos.x, data.DisplayPos.y, 0);
  const auto set_row = [&](GLint location, int row) {
    const double offset = from_picture(row, 2) - from_picture.row(row).dot(origin);
    glUniform3f(location, static_cast<float>(from_picture(row, 0)), static_cast<float>(from_picture(row, 1)), static_cast<float>(offset));
  };
  set_row(impl_->to_x, 0);
  set_row(impl_->to_y, 1);
  glBindVertexArray(impl_->vertex_array);
  glBindBuffer(GL_ARRAY_BUFFER, impl_->vertices);
  glBindTexture(GL_TEXTURE_2D, impl_->atlas);

  for (int l = 0; l < data.CmdListsCount; ++l) {
    const ImDrawList& list = *data.CmdLists[l];
    glBufferData(GL_ARRAY_BUFFER, list.VtxBuffer.size_in_bytes(), list.VtxBuffer.Data, GL_STREAM_DRAW);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, list.IdxBuffer.size_in_bytes(), list.IdxBuffer.Data, GL_STREAM_DRAW);
    for (const ImDrawCmd& command : list.CmdBuffer) {
      const ImVec4& clip = command.ClipRect;
      if (!(clip.z > clip.x && clip.w > clip.y) || command.ElemCount == 0) continue;
      glUniform4f(impl_->clip, clip.x, clip.y, clip.z, clip.w);
      glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(command.ElemCount), sizeof(ImDrawIdx) == 2 ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT,
                     reinterpret_cast<const void*>(static_cast<std::size_t>(command.IdxOffset) * sizeof(ImDrawIdx)));
    }
  }
}

}  // namespace prismesh::kiosk::panels

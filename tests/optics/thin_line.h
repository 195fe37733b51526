// A line one pixel wide without antialiasing, drawn into an eye's image as an overlay: the hardest thing to show through every second
// column.
#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include <GLES3/gl31.h>

namespace prismesh::optics {

/// Needs a current context of OpenGL ES 3.1 for its whole life.
class ThinLine {
 public:
  ThinLine() {
    const auto compile = [](GLenum kind, const char* text) {
      const GLuint shader = glCreateShader(kind);
      glShaderSource(shader, 1, &text, nullptr);
      glCompileShader(shader);
      return shader;
    };
    const GLuint vertex = compile(GL_VERTEX_SHADER,
                                  "#version 310 es\nuniform vec4 ends; void main() { gl_Position = vec4(gl_VertexID == 0 ? ends.xy : "
                                  "ends.zw, 0.0, 1.0); }");
    const GLuint fragment =
        compile(GL_FRAGMENT_SHADER, "#version 310 es\nprecision mediump float; out vec4 ink; void main() { ink = vec4(1.0); }");
    program_ = glCreateProgram();
    for (const GLuint shader : {vertex, fragment}) {
      glAttachShader(program_, shader);
      glDeleteShader(shader);
    }
    glLinkProgram(program_);
    glGenVertexArrays(1, &no_attributes_);
  }
  ~ThinLine() {
    glDeleteProgram(program_);
    glDeleteVertexArrays(1, &no_attributes_);
  }
  ThinLine(const ThinLine&) = delete;
  ThinLine& operator=(const ThinLine&) = delete;

  /// 200 pixels of a picture of `size` pixels, `degrees` from its rows, through `middle` (pixels from the centre, up), white on a grey of
  /// 0..1.
  void draw(double degrees, std::array<double, 2> middle, std::array<int, 2> size, float grey = 0) const {
    const double angle = degrees * std::numbers::pi / 180;
    const std::array<double, 2> half{100 * std::cos(angle), 100 * std::sin(angle)};
    std::array<float, 4> ends{};
    for (std::size_t i = 0; i < 4; ++i) ends[i] = static_cast<float>(2 * (middle[i % 2] + (i < 2 ? -1 : 1) * half[i % 2]) / size[i % 2]);
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_BLEND);
    glClearColor(grey, grey, grey, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glUseProgram(program_);
    glUniform4fv(glGetUniformLocation(program_, "ends"), 1, ends.data());
    glBindVertexArray(no_attributes_);
    glLineWidth(1);
    glDrawArrays(GL_LINES, 0, 2);
  }

 private:
  GLuint program_ = 0, no_attributes_ = 0;
};

}  // namespace prismesh::optics

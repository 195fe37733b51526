#include "kiosk/render/gl.h"

#include <cstdio>
#include <string_view>
#include <vector>

namespace prismesh::kiosk::render::gl {

namespace {

std::string shader_log(GLuint shader) {
  GLint length = 0;
  glGetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
  std::vector<char> log(static_cast<std::size_t>(length) + 1);
  glGetShaderInfoLog(shader, length, nullptr, log.data());
  return log.data();
}

/// Compiles one stage and attaches it to the program, which then owns it.
Result<void> attach(GLuint program, GLenum kind, const std::string& name, std::string_view source) {
  const GLuint shader = glCreateShader(kind);
  const char* text = source.data();
  const auto length = static_cast<GLint>(source.size());
  glShaderSource(shader, 1, &text, &length);
  glCompileShader(shader);
  GLint compiled = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  const std::string log = compiled != 0 ? "" : shader_log(shader);
  glAttachShader(program, shader);
  glDeleteShader(shader);
  if (compiled == 0) {
    const char* stage = kind == GL_VERTEX_SHADER ? "vertex" : "fragment";
    return fail("OpenGL", "the graphics driver refuses the " + std::string(stage) + " shader \"" + name + "\": " + log);
  }
  return {};
}

}  // namespace

Result<Program> Program::link(const std::string& name, std::string_view vertex, std::string_view fragment) {
  Program program;
  program.name_ = glCreateProgram();
  if (program.name_ == 0) return fail("OpenGL", "no shader program could be made; the graphics context is gone");
  if (const auto done = attach(program.name_, GL_VERTEX_SHADER, name, vertex); !done) return fail(done.error());
  if (const auto done = attach(program.name_, GL_FRAGMENT_SHADER, name, fragment); !done) return fail(done.error());
  glLinkProgram(program.name_);
  GLint linked = 0;
  glGetProgramiv(program.name_, GL_LINK_STATUS, &linked);
  if (linked == 0) {
    char log[2048] = "";
    glGetProgramInfoLog(program.name_, sizeof log, nullptr, log);
    return fail("OpenGL", "the graphics driver can't link the shader program \"" + name + "\": " + log);
  }
  return program;
}

std::size_t bytes_held(const Buffer& buffer) {
  if (!buffer) return 0;
  GLint64 bytes = 0;
  glBindBuffer(GL_COPY_READ_BUFFER, buffer.get());  // a binding that nothing is drawn from
  glGetBufferParameteri64v(GL_COPY_READ_BUFFER, GL_BUFFER_SIZE, &bytes);
  glBindBuffer(GL_COPY_READ_BUFFER, 0);
  return static_cast<std::size_t>(bytes);
}

bool has_clip_distance() {
  GLint count = 0;
  glGetIntegerv(GL_NUM_EXTENSIONS, &count);
  for (GLint i = 0; i < count; ++i) {
    const auto* name = reinterpret_cast<const char*>(glGetStringi(GL_EXTENSIONS, static_cast<GLuint>(i)));
    if (name != nullptr && std::string_view(name) == "GL_EXT_clip_cull_distance") return true;
  }
  return false;
}

Result<void> check_context() {
  const auto* version = reinterpret_cast<const char*>(glGetString(GL_VERSION));
  if (version == nullptr) return fail("OpenGL", "there is no graphics context on this thread");
  int major = 0, minor = 0;
  if (std::sscanf(version, "OpenGL ES %d.%d", &major, &minor) != 2 || major < 3 || (major == 3 && minor < 1))
    return fail("OpenGL", std::string("OpenGL ES 3.1 is needed; this graphics driver offers \"") + version + "\"");
  return {};
}

}  // namespace prismesh::kiosk::render::gl

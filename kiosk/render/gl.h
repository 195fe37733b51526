// RAII for OpenGL ES objects, and shader programs with errors as text.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include <GLES3/gl31.h>
#include <Eigen/Core>

#include "base/error.h"

namespace prismesh::kiosk::render::gl {

/// Owns the name of one object; 0: none.
template <void (*Generate)(GLsizei, GLuint*), void (*Delete)(GLsizei, const GLuint*)>
class Object {
 public:
  Object() = default;
  static Object make() {
    Object object;
    Generate(1, &object.name_);
    return object;
  }
  Object(Object&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  Object& operator=(Object&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  ~Object() {
    if (name_ != 0) Delete(1, &name_);
  }
  GLuint get() const { return name_; }
  explicit operator bool() const { return name_ != 0; }

 private:
  GLuint name_ = 0;
};

namespace detail {
inline void gen_textures(GLsizei n, GLuint* names) { glGenTextures(n, names); }
inline void delete_textures(GLsizei n, const GLuint* names) { glDeleteTextures(n, names); }
inline void gen_buffers(GLsizei n, GLuint* names) { glGenBuffers(n, names); }
inline void delete_buffers(GLsizei n, const GLuint* names) { glDeleteBuffers(n, names); }
inline void gen_arrays(GLsizei n, GLuint* names) { glGenVertexArrays(n, names); }
inline void delete_arrays(GLsizei n, const GLuint* names) { glDeleteVertexArrays(n, names); }
inline void gen_framebuffers(GLsizei n, GLuint* names) { glGenFramebuffers(n, names); }
inline void delete_framebuffers(GLsizei n, const GLuint* names) { glDeleteFramebuffers(n, names); }
inline void gen_renderbuffers(GLsizei n, GLuint* names) { glGenRenderbuffers(n, names); }
inline void delete_renderbuffers(GLsizei n, const GLuint* names) { glDeleteRenderbuffers(n, names); }
}  // namespace detail

using Texture = Object<detail::gen_textures, detail::delete_textures>;
using Buffer = Object<detail::gen_buffers, detail::delete_buffers>;
using VertexArray = Object<detail::gen_arrays, detail::delete_arrays>;
using Framebuffer = Object<detail::gen_framebuffers, detail::delete_framebuffers>;
using Renderbuffer = Object<detail::gen_renderbuffers, detail::delete_renderbuffers>;

/// Bytes that a buffer has on the graphics card; 0 for none.
std::size_t bytes_held(const Buffer& buffer);

class Program {
 public:
  /// Compiles and links a program. Errors: the driver's message about the stage that it refuses, with `name`.
  static Result<Program> link(const std::string& name, std::string_view vertex, std::string_view fragment);
  Program() = default;
  Program(Program&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  Program& operator=(Program&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  ~Program() {
    if (name_ != 0) glDeleteProgram(name_);
  }

  void use() const { glUseProgram(name_); }
  // Set a uniform. The program must be current. A name that the program doesn't have is ignored.
  void set(const char* uniform, int value) const { glUniform1i(location(uniform), value); }
  void set(const char* uniform, float value) const { glUniform1f(location(uniform), value); }
  void set(const char* uniform, float x, float y) const { glUniform2f(location(uniform), x, y); }
  void set(const char* uniform, float x, float y, float z, float w) const { glUniform4f(location(uniform), x, y, z, w); }
  void set(const char* uniform, const Eigen::Vector4f& v) const { set(uniform, v.x(), v.y(), v.z(), v.w()); }
  void set(const char* uniform, const Eigen::Vector3f& v) const { glUniform3f(location(uniform), v.x(), v.y(), v.z()); }
  void set(const char* uniform, int x, int y) const { glUniform2i(location(uniform), x, y); }
  void set(const char* uniform, const Eigen::Matrix2f& m) const { glUniformMatrix2fv(location(uniform), 1, GL_FALSE, m.data()); }
  void set(const char* uniform, const Eigen::Matrix4f& m) const { glUniformMatrix4fv(location(uniform), 1, GL_FALSE, m.data()); }
  void set(const char* uniform, const Eigen::Matrix3f& m) const { glUniformMatrix3fv(location(uniform), 1, GL_FALSE, m.data()); }

 private:
  GLint location(const char* uniform) const { return glGetUniformLocation(name_, uniform); }
  GLuint name_ = 0;
};

/// GL_CLIP_DISTANCE0_EXT.
inline constexpr GLenum kClipDistance = 0x3000;
/// Whether shaders can cut triangles off at a plane: GL_EXT_clip_cull_distance.
bool has_clip_distance();

/// Checks that the current context is OpenGL ES 3.1 or later. Errors: none, or an older one, with its version.
Result<void> check_context();

}  // namespace prismesh::kiosk::render::gl

// Links the shader programs, once for each renderer. Errors: a shader that the driver refuses, with its message.
#pragma once

#include <string>

#include "kiosk/render/gl.h"

namespace prismesh::kiosk::render {

/// Texture units of the programs.
namespace unit {
inline constexpr unsigned kPositions = 0;
inline constexpr unsigned kConnectivity = 1;
inline constexpr unsigned kSurface = 2;
inline constexpr unsigned kLines = 3;
inline constexpr unsigned kSelection = kLines;  ///< no program uses both
inline constexpr unsigned kLeft = 4;
inline constexpr unsigned kRight = 5;
inline constexpr unsigned kPhases = 6;
inline constexpr unsigned kPartLooks = 7;
inline constexpr unsigned kField = 8;
inline constexpr unsigned kColourMap = 9;
inline constexpr unsigned kPaint = 10;
inline constexpr unsigned kCoarse = 11;
inline constexpr unsigned kPlates = 12;
inline constexpr unsigned kThicknesses = 13;
}  // namespace unit

/// Version and precision: the start of every shader.
const std::string& shader_head();
/// Vertex shader of one triangle that covers the image.
const std::string& cover_vertex_shader();

struct Shaders {
  gl::Program ground;      ///< the background: one triangle over the whole image
  gl::Program shells;      ///< four vertices a shell, read from textures
  gl::Program plates;      ///< the six faces of each shell's plate: the same vertices, an instance for each face
  gl::Program coarse;      ///< triangles that stand for shells, three vertices each
  gl::Program items;       ///< the same shells; the output is shell index + 1
  gl::Program lines;       ///< six vertices a line, read from textures; any width
  gl::Program nodes;       ///< octahedra, six vertices a node, read from rows of indices
  gl::Program flat_nodes;  ///< squares instead of octahedra, four vertices a node
  gl::Program glyphs;      ///< six vertices an instance
  gl::Program handle;      ///< a mesh in screen millimetres
  gl::Program pane;        ///< the area of one of two views, into the stencil buffer: six vertices from four corners
  gl::Program rectangle;
  gl::Program screen_lines;   ///< lines in the screen's plane
  gl::Program shadow_caster;  ///< shells projected onto a plane
  gl::Program alert;          ///< the texture on shells that touch: six vertices a shell, read from textures
  gl::Program shadow_plane;   ///< six vertices: the plane with its shadow

  static Result<Shaders> link();
};

}  // namespace prismesh::kiosk::render

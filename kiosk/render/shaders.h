// The shader programs, linked once.
#pragma once

#include <string>

#include "kiosk/render/gl.h"

namespace prismesh::kiosk::render {

/// Texture units that the programs read from.
namespace unit {
inline constexpr unsigned kPositions = 0;
inline constexpr unsigned kConnectivity = 1;
inline constexpr unsigned kSurface = 2;
inline constexpr unsigned kLines = 3;
inline constexpr unsigned kSelection = kLines;  ///< never drawn together
inline constexpr unsigned kLeft = 4;
inline constexpr unsigned kRight = 5;
inline constexpr unsigned kPhases = 6;
inline constexpr unsigned kPartLooks = 7;
inline constexpr unsigned kField = 8;
inline constexpr unsigned kColourMap = 9;
}  // namespace unit

/// What every shader begins with.
const std::string& shader_head();
/// One triangle that covers the image.
const std::string& cover_vertex_shader();

struct Shaders {
  gl::Program ground;      ///< one triangle over the whole image
  gl::Program shells;      ///< six vertices a shell, pulled from textures
  gl::Program items;       ///< the same shells, their numbers as colours
  gl::Program lines;       ///< six vertices a line, pulled, as broad as wished
  gl::Program nodes;       ///< octahedra, six vertices a node, pulled from rows of indices
  gl::Program flat_nodes;  ///< squares in their place, four vertices
  gl::Program glyphs;      ///< flat signs, six vertices an instance
  gl::Program handle;      ///< a mesh in screen millimetres
  gl::Program pane;        ///< where one of two views lies: six vertices given as corners, no colour
  gl::Program rectangle;
  gl::Program pencil;         ///< lines in the plane of the screen
  gl::Program shadow_caster;  ///< shells on a plane
  gl::Program shadow_plane;   ///< six vertices: the plane with its shadow

  static Result<Shaders> link();
};

}  // namespace prismesh::kiosk::render

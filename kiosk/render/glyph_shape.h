// Chooses a shell's quality glyphs and their positions on the shell. No OpenGL. glyph_shaders.cpp draws them; docs/drawing.md shows them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/model/model.h"
#include "mesh/quality/shell_state.h"

namespace prismesh::kiosk::render {

/// Shape of a glyph, by what is wrong with the shell.
enum class GlyphShape : std::uint8_t {
  warped,       ///< the shell's outline, and thick the diagonal about which it bends more
  short_edge,   ///< a bar along the edge between stops; of a triangle, along its smallest height
  long_edge,    ///< a line along the edge with arrowheads
  small_angle,  ///< the corner's sector, filled
  large_angle,  ///< an arc at the corner
  stretched,    ///< a slender box along the longest edge's direction
  cluster,      ///< a ring with three spokes, at a node with too many triangles; no state of a shell
  defect,       ///< a cross
  other,        ///< a ring: skew, Jacobian, taper
};
inline constexpr int kGlyphShapeCount = 9;

/// Glyph::kind for the shaders: shape (four bits), failing, position on the shell (two bits), level.
inline constexpr std::uint32_t kFailingGlyph = 16;
inline constexpr std::uint32_t kGlyphPlaceShift = 5;
inline constexpr std::uint32_t kGlyphLevelShift = 8;  ///< above it the level (glyph_levels.h), eight bits
inline constexpr std::uint32_t kShownAtEveryLevel = 255;
inline constexpr std::uint32_t kMarkedGlyph = 15;  ///< instead of a shape: a frame around the shell that the view went to

/// The shapes of the failing metrics if any fails, else of those that warn. `other` only if no other shape applies; a defect has only its
/// own. Empty for a shell that passes.
std::vector<GlyphShape> shapes_of(const mesh::quality::ShellState& state);
inline constexpr std::size_t kMaxShapesOfShell = 6;                      ///< that shapes_of returns
inline constexpr std::size_t kMaxGlyphsOfShell = kMaxShapesOfShell + 3;  ///< with a cluster at each corner of a triangle

/// Finds the diagonal (0: from corner 0 to 2, 1: from 1 to 3), edge (k: from corner k to the next) or corner k that the shape marks.
/// `corners`: positions of the 3 or 4 corners. For a triangle's short_edge the corner at which the smallest height starts. 0 if the shape
/// has no position to choose, or a coordinate isn't finite.
unsigned glyph_place(GlyphShape shape, std::span<const mesh::Vec3> corners);

/// An instance for the shaders, which read the corners from the model's textures.
struct Glyph {
  std::uint32_t shell = 0;
  std::uint32_t kind = 0;
  bool operator==(const Glyph&) const = default;
};

}  // namespace prismesh::kiosk::render

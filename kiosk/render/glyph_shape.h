// What a quality glyph looks like and where on its shell it stands: pure. Drawing: sign_shaders.cpp; pictures: docs/drawing.md.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/model/model.h"
#include "mesh/quality/shell_state.h"

namespace prismesh::kiosk::render {

/// What is wrong, by the shape that shows it on the shell itself.
enum class GlyphShape : std::uint8_t {
  warped,       ///< its outline, and thick the diagonal about which it is bent more
  short_edge,   ///< a bar along the edge between stops; of a triangle, along its smallest height
  long_edge,    ///< a line along the edge with arrowheads
  small_angle,  ///< the corner's sector, filled
  large_angle,  ///< an arc at the corner
  stretched,    ///< a slender box along the longest edge's direction
  cluster,      ///< three spokes in a ring, at a node where triangles crowd
  defect,       ///< a cross
  other,        ///< a ring: skew, Jacobian, taper
};
inline constexpr int kGlyphShapeCount = 9;

/// A glyph's word for the shaders: shape (four bits), failing, place (two bits).
inline constexpr std::uint32_t kFailingGlyph = 16;
inline constexpr std::uint32_t kGlyphPlaceShift = 5;
inline constexpr std::uint32_t kMarkedGlyph = 15;  ///< in place of a shape: the shell that is looked at

/// The shapes of a state's worst: of the failing metrics if any fails, else of the warning ones. `other` only where nothing tells more, a
/// defect alone. Empty for a shell that is ok.
std::vector<GlyphShape> shapes_of(const mesh::quality::ShellState& state);
inline constexpr std::size_t kMaxShapesOfShell = 6;  ///< at once

/// Which diagonal (0: from corner 0 to 2, 1: from 1 to 3), edge (k: from corner k to the next) or corner the shape marks, from the corners'
/// places (3 or 4); of a triangle's short_edge the corner from which the smallest height falls. 0 where there is nothing to choose, or a
/// coordinate is no number.
unsigned glyph_place(GlyphShape shape, std::span<const mesh::Vec3> corners);

/// An instance for the shaders, which take the corners from their textures.
struct Glyph {
  std::uint32_t shell = 0;
  std::uint32_t kind = 0;
  bool operator==(const Glyph&) const = default;
};

}  // namespace prismesh::kiosk::render

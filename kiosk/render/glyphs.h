// Which shells get a quality glyph, and of what shape: pure.
#pragma once

#include <cstdint>
#include <span>
#include <unordered_set>
#include <vector>

#include "kiosk/render/model_table.h"
#include "mesh/quality/criteria.h"

namespace prismesh::kiosk::render {

/// What is wrong, by the shape that shows it.
enum class GlyphShape : std::uint8_t { warped, length, angle, aspect, other };
inline constexpr int kGlyphShapeCount = 5;

/// The shape of a state's worst: of the failing metrics if any fails, else of the warning ones; the first in the order of GlyphShape.
/// Precondition: the state isn't ok.
GlyphShape shape_of(const mesh::quality::ShellState& state);

struct Glyph {
  std::array<float, 3> at;  ///< deck coordinates from the model's origin
  std::uint32_t kind = 0;   ///< GlyphShape, plus kFailingGlyph
};
inline constexpr std::uint32_t kFailingGlyph = 8;
std::uint32_t glyph_kind(const mesh::quality::ShellState& state);

/// Shells that aren't ok, kept per chunk so that a change costs what it touches.
class GlyphList {
 public:
  void update(const ModelTable& table, bool visibility_changed);

  struct Chosen {
    std::vector<Glyph> glyphs;  ///< warnings first, so that failures are drawn over them
    std::size_t left_out = 0;
  };
  /// At most `cap`, failures before warnings, evenly spread over the list where not all find room. `except`: shells that show
  /// something newer.
  Chosen choose(const ModelTable& table, const mesh::Vec3& origin, std::size_t cap, const std::unordered_set<std::uint32_t>& except) const;

 private:
  struct Bad {
    std::uint32_t shell = 0;
    std::uint32_t kind = 0;
  };
  struct Chunk {
    std::array<std::uint64_t, 2> versions{};  ///< of quality and parts
    bool known = false;
    std::vector<Bad> bad;
  };
  std::vector<Chunk> chunks_;
};

}  // namespace prismesh::kiosk::render

// Which shells get quality glyphs: pure.
#pragma once

#include <array>
#include <cstdint>
#include <unordered_set>
#include <vector>

#include "kiosk/render/glyph_shape.h"
#include "kiosk/render/model_table.h"

namespace prismesh::kiosk::render {

/// Glyphs of shells that aren't ok and of nodes where triangles crowd, kept per chunk so that a change costs what it touches.
class GlyphList {
 public:
  /// `damaged`: only by what the document's edits made worse. Clusters cost a pass over the shells where these have changed.
  void update(const ModelTable& table, bool visibility_changed, bool topology_changed, bool damaged);

  struct Chosen {
    std::vector<Glyph> glyphs;  ///< warnings first, so that failures are drawn over them
    std::size_t left_out = 0;
  };
  /// At most `cap`, failures before warnings, evenly spread over the list where not all find room. `except`: shells that show
  /// something newer.
  Chosen choose(const ModelTable& table, std::size_t cap, const std::unordered_set<std::uint32_t>& except) const;

 private:
  struct Bad {
    std::uint32_t shell = 0;
    GlyphShape shape{};
    bool failing = false;
    std::uint8_t corner = 0;  ///< of a cluster
  };
  struct Chunk {
    std::array<std::uint64_t, 2> versions{};  ///< of quality (or damage) and parts
    bool known = false;
    std::vector<Bad> bad;
  };
  /// Nodes with more triangles about them than the source's limit; where no quad meets them it is a mesh of triangles.
  void find_clusters(const ModelTable& table);

  std::vector<Chunk> chunks_;
  std::vector<Bad> clusters_;
  bool damaged_ = false;
};

}  // namespace prismesh::kiosk::render

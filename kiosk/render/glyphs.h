// Chooses the shells that get quality glyphs. No OpenGL.
#pragma once

#include <array>
#include <cstdint>
#include <unordered_set>
#include <vector>

#include "kiosk/render/glyph_shape.h"
#include "kiosk/render/model_table.h"

namespace prismesh::kiosk::render {

/// Glyphs of shells that warn or fail and of nodes with too many triangles, kept by chunk. An update visits only the chunks that changed.
class GlyphList {
 public:
  /// Takes over a model. `damaged`: counts only what the document's edits made worse.
  void update(const ModelTable& table, bool visibility_changed, bool topology_changed, bool damaged);

  struct Chosen {
    std::vector<Glyph> glyphs;  ///< warnings first, so that failures are drawn over them
    std::size_t left_out = 0;
  };
  /// Chooses at most `cap` glyphs, failures before warnings. If there are more, it takes them at even steps through the list. `except`:
  /// shells to leave out, as a preview shows them.
  Chosen choose(const ModelTable& table, std::size_t cap, const std::unordered_set<std::uint32_t>& except) const;

 private:
  struct BadShell {
    std::uint32_t shell = 0;
    GlyphShape shape{};
    bool failing = false;
    std::uint8_t corner = 0;  ///< of a cluster
  };
  struct Chunk {
    std::array<std::uint64_t, 2> versions{};  ///< of quality (or damage) and parts
    bool known = false;
    std::vector<BadShell> bad;
  };
  void find_clusters(const ModelTable& table, bool damaged);

  std::vector<Chunk> chunks_;
  std::vector<BadShell> clusters_;
  bool damaged_ = false;
};

}  // namespace prismesh::kiosk::render

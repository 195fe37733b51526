// The section of the panel at the right that counts shells by their quality.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "mesh/quality/report.h"

namespace prismesh::kiosk::tools::quality {

struct CountsFacts {
  mesh::quality::Counts counts;
  std::size_t clusters = 0;                       ///< nodes with too many triangles; a pull doesn't change them
  std::optional<mesh::quality::Counts> pulled{};  ///< of the document as the pull would leave it
  std::string hidden_glyphs{};                    ///< which quality glyphs are hidden on purpose; empty: none
  std::size_t glyphs_left_out = 0;                ///< glyphs beyond the renderer's cap
};

/// Lays the section out (inside Gui::layout).
void counts_section(const CountsFacts& facts);

}  // namespace prismesh::kiosk::tools::quality

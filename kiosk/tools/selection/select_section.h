// The section of the document's panel that says what is selected, and how outlines and regions select.
#pragma once

#include <cstdint>
#include <optional>

#include "kiosk/panels/panel_layout.h"
#include "mesh/document/edit.h"

namespace prismesh::kiosk::tools::selection {

inline constexpr int kRegionBounds = 5;  ///< the number of values of RegionBy
/// Whether the angle counts for this bound.
inline bool has_angle(mesh::document::RegionBy by) {
  return by == mesh::document::RegionBy::features || by == mesh::document::RegionBy::creases;
}

/// What bounds a region, in a word or two.
const char* bounds_words(mesh::document::RegionBy by);

struct RegionSettings {
  mesh::document::RegionBy by = mesh::document::RegionBy::features;
  double angle = 30;  ///< degrees
  bool across_welds = false;
};

struct SelectFacts {
  std::uint64_t nodes = 0, shells = 0;  ///< selected
  bool lasso = true;                    ///< outlines are lassos, not rectangles
  bool through = false;                 ///< they take hidden nodes too
  RegionSettings region{};
};

/// Lays the section out (inside Gui::layout). Returns other settings, if the user chose some.
std::optional<RegionSettings> select_section(const SelectFacts& facts, panels::PanelLayout& layout);

}  // namespace prismesh::kiosk::tools::selection

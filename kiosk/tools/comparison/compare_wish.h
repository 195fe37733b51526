// What the user wants to compare: the field that colours show, the states that are shown, how values become colours.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "kiosk/render/colour_map.h"

namespace prismesh::kiosk::tools::comparison {

struct CompareWish {
  std::string field;                                ///< a name for mesh::document::field_wish; empty: other colours
  std::string against = "opened";                   ///< or "surface", or another deck's path; empty: not said yet
  std::optional<std::uint64_t> against_generation;  ///< goes before `against`
  std::string from, to;                             ///< expressions, of "distance"
  std::optional<std::uint64_t> shown;               ///< a generation; empty: the current one, always
  bool two_views = false;
  std::optional<std::uint64_t> beside;  ///< what the left one of two views shows; empty: the current one
  render::ColourMap map = render::ColourMap::crimson;
  bool bands = false;
  bool operator==(const CompareWish&) const = default;
};

/// Whether the field compares with something.
inline bool needs_against(const CompareWish& wish) { return wish.field == "displacement" || wish.field == "distance-to-original"; }
/// Whether it is a state of this document, not another deck.
inline bool is_state(const std::string& against) { return against == "opened" || against == "surface"; }

}  // namespace prismesh::kiosk::tools::comparison

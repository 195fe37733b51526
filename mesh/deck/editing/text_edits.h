// New text for a deck's files while it is being collected.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "mesh/deck/editing/rounding.h"
#include "mesh/deck/writing/card_writer.h"

namespace prismesh::mesh::deck {

/// Where a new block of cards is inserted, and the keyword line it begins with.
struct NewBlockPlace {
  std::uint32_t file = 0;
  std::size_t offset = 0;
  std::string header;
  auto operator<=>(const NewBlockPlace&) const = default;
};

/// Nodes and shells whose cards were written or removed.
struct CardCounts {
  std::size_t nodes_moved = 0;
  std::size_t nodes_added = 0;
  std::size_t nodes_removed = 0;
  std::size_t shells_changed = 0;
  std::size_t shells_added = 0;
  std::size_t shells_removed = 0;
  std::size_t elements_added = 0;  ///< that are no shells
  std::size_t shells_turned = 0;   ///< whose material angles were changed because their first edge has turned
};

struct TextEdits {
  std::vector<FileReplacement> replacements;        ///< in any order of places; insertions at one place keep their order
  std::map<NewBlockPlace, std::string> new_blocks;  ///< header and cards of each, every line ended
  Rounding rounding;
  CardCounts counts;
};

}  // namespace prismesh::mesh::deck

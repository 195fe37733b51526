// What an edit must carry along in the cards that name nodes and shells: docs/formats/editing.md has the rules.
#pragma once

#include <functional>
#include <vector>

#include "base/error.h"
#include "mesh/deck/data/deck.h"
#include "mesh/deck/writing/card_writer.h"
#include "mesh/model/topology_change.h"

namespace prismesh::mesh::deck {

struct Carried {
  std::vector<std::pair<std::uint32_t, Replacement>> replacements;  ///< with their files
  std::size_t cards = 0;                                            ///< sets, segments and cards that change
};

/// Errors: the rules forbid it, or the format's writer can't; with file and line of the card that stands in the way.
Result<Carried> carry_along(const Deck& deck, const Model& original, const Model& model, const Changes& changes, const CardWriter& writer);

/// What is added to the ids of a file's text; nullopt: it can't be told, or differs from place to place.
std::optional<IdOffsets> offsets_in(const Deck& deck, std::uint32_t file);

}  // namespace prismesh::mesh::deck

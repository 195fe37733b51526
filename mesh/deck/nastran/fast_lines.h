// Reads the cards that make up most of a deck without cutting them into fields: grid points and shells in small fields on one line, and
// grid points in large fields on two lines.
#pragma once

#include <cstddef>
#include <string_view>

#include "mesh/deck/nastran/card.h"
#include "mesh/deck/nastran/piece_entities.h"

namespace prismesh::mesh::deck::nastran {

/// Shells that were read here.
struct FastShellCounts {
  std::size_t quads = 0;
  std::size_t trias = 0;
};

/// Adds the card that begins with `line` of `text`. Returns where the line after the card begins; 0: it isn't such a card, or has something
/// unusual, and nothing was added.
std::size_t read_fast(std::string_view text, const Line& line, PieceEntities& entities, FastShellCounts& counts);

}  // namespace prismesh::mesh::deck::nastran

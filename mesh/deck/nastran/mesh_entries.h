// Reads grid points and elements from cards that are cut into fields.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/deck/nastran/card.h"
#include "mesh/deck/nastran/elements.h"
#include "mesh/deck/nastran/piece_entities.h"
#include "mesh/deck/nastran/piece_facts.h"
#include "mesh/deck/nastran/references.h"

namespace prismesh::mesh::deck::nastran {

/// A card that is being read.
struct EntryCard {
  const Card& fields;
  CardPlace place;
  bool is_too_long = false;    ///< it has more fields than a card can have; the last ones aren't in `fields`
  bool is_replicated = false;  ///< a replication made it, or makes cards from it
};

/// Where the parts of a piece's content go.
struct PieceTarget {
  PieceCards& cards;
  PieceFacts& facts;
  PieceEntities& entities;
  ReferenceReader& references;
  std::vector<std::int64_t> nodes{};  ///< of the element being read; kept so that elements don't allocate
};

/// The piece can't be read from here on. Only the first such error counts.
void fail_at(PieceCards& cards, std::size_t offset, std::string message);

/// Warns that the last fields of a card aren't read.
void note_too_long(const EntryCard& card, std::string_view entry, PieceFacts& facts);

void read_grid(const EntryCard& card, PieceTarget& target);
void read_element(const EntryCard& card, const ElementForm& form, PieceTarget& target);

}  // namespace prismesh::mesh::deck::nastran

// Reads what the blocks of a deck name: nodes, elements and parts, by the table of naming_rules.h.
#pragma once

#include <cstdint>

#include "mesh/deck/radioss/block.h"
#include "mesh/deck/radioss/definitions.h"
#include "mesh/model/references.h"

namespace prismesh::mesh::deck::radioss {

/// Referrer::style of a block: `old`: its fields have 8 columns; `added`: what is added to its ids.
std::uint16_t referrer_style(bool old, const IdOffsets& added);
bool is_old(std::uint16_t referrer_style);
bool adds_to_ids(std::uint16_t referrer_style);

/// Adds what the block names. A block that no rule covers is added as unread text.
void read_references(const Block& block, const Keyword& keyword, const DeckTables& tables, References& references);

}  // namespace prismesh::mesh::deck::radioss

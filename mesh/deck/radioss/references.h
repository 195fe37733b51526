// Which blocks name nodes, elements and parts, and where on their cards.
// Source: Radioss Reference Guide, the pages of the keywords.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "mesh/deck/radioss/block.h"
#include "mesh/deck/radioss/definitions.h"
#include "mesh/model/references.h"

namespace prismesh::mesh::deck::radioss {

/// How a block names entities.
enum class Naming : std::uint8_t {
  nothing,   ///< it doesn't, or only sets of them
  list,      ///< every field of every card
  range,     ///< pairs of first and last
  step,      ///< first, last and step
  segments,  ///< a segment's id and its corners
  places,    ///< some fields of some cards
  unknown,
};

/// One field, or the same field of all cards from one on.
struct NamingPlace {
  std::uint8_t card = 0;  ///< from 1; 0: ends the places
  bool onwards = false;
  std::uint8_t field = 0;  ///< from 1
  std::uint8_t fields = 1;
};

struct NamingRule {
  std::string_view keyword;  ///< "GRNOD/NODE": words that the block's begin with
  Naming naming = Naming::nothing;
  Referred referred = Referred::node;
  NamingPlace first{};
  NamingPlace second{};
};

/// The rule of a block's keyword, the most special one; one of `unknown` where there is none.
NamingRule naming_rule(const Keyword& keyword);

/// Referrer::style of a block: how wide its fields are, and whether ids are added to those it gives.
std::uint16_t referrer_style(bool old, const IdOffsets& added);
bool is_old(std::uint16_t referrer_style);
bool adds_to_ids(std::uint16_t referrer_style);

/// Adds what the block names, or the block as one nobody understands.
void read_references(const Block& block, const Keyword& keyword, const Surroundings& around, References& references);

}  // namespace prismesh::mesh::deck::radioss

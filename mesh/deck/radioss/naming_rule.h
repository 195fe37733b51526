// Describes how a block names nodes, elements and parts: in which fields of which cards.
#pragma once

#include <cstdint>
#include <string_view>

#include "mesh/model/references.h"

namespace prismesh::mesh::deck::radioss {

/// How a block names entities.
enum class Naming : std::uint8_t {
  nothing,   ///< it names none, or only sets of them
  list,      ///< in every field of every card
  range,     ///< by pairs of first and last
  step,      ///< by first, last and step
  segments,  ///< a segment's id and its corners
  places,    ///< in some fields of some cards
  unknown,   ///< no rule covers the block
};

/// Some fields of one card, or of all cards from one on.
struct NamingPlace {
  std::uint8_t card = 0;   ///< from 1; 0: no place
  bool onwards = false;    ///< also the cards behind it
  std::uint8_t field = 0;  ///< from 1
  std::uint8_t fields = 1;
};

struct NamingRule {
  std::string_view keyword;  ///< the block's first words: "GRNOD/NODE"
  Naming naming = Naming::nothing;
  Referred referred = Referred::node;
  NamingPlace first{};
  NamingPlace second{};
};

}  // namespace prismesh::mesh::deck::radioss

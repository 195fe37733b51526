// How a block names nodes, elements and parts: which fields of which cards.
#pragma once

#include <cstdint>
#include <string_view>

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

}  // namespace prismesh::mesh::deck::radioss

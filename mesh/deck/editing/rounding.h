// Numbers that lost digits when they were written to the fields of cards.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "mesh/model/model.h"

namespace prismesh::mesh::deck {

struct Rounding {
  std::size_t count = 0;     ///< numbers that their fields can't hold exactly
  double largest_error = 0;  ///< in the unit of the number
  std::string first;         ///< "deck.k:12 (node 7)"
  /// Nodes whose coordinates were rounded, with the place that a reader of the written text gets; in the basic system.
  std::vector<std::pair<NodeIndex, Vec3>> nodes;
};

}  // namespace prismesh::mesh::deck

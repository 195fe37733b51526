// What the fields of cards made of numbers.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "mesh/model/model.h"

namespace prismesh::mesh::deck {

/// Numbers that their fields can't hold to the last bit.
struct Rounding {
  std::size_t count = 0;
  double largest_error = 0;
  std::string first;  ///< "deck.k:12 (node 7)"
  /// Nodes whose coordinates are among them, with the place that a reader of the text finds them at.
  std::vector<std::pair<NodeIndex, Vec3>> nodes;
};

}  // namespace prismesh::mesh::deck

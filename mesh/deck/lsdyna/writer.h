// Node cards with new coordinates, everything else about them kept.
#pragma once

#include <string>
#include <string_view>

#include "mesh/deck/deck.h"

namespace prismesh::mesh::deck::lsdyna {

/// A card rewritten.
struct RewrittenCard {
  std::string text;
  int rounded = 0;            ///< coordinates whose field can't hold them exactly
  double largest_error = 0;   ///< of those
  bool by_parameter = false;  ///< a coordinate that changes is given by a parameter: the text isn't usable
};

/// `line` is the card without its line end. Only the fields of coordinates that differ between `from` and `to` change; the
/// rest of the line, the columns or commas, and the side the numbers lean to stay.
RewrittenCard rewrite_node_card(std::string_view line, Columns columns, const Vec3& from, const Vec3& to);

}  // namespace prismesh::mesh::deck::lsdyna

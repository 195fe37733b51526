// The grammar of id expressions, apart from what a model makes of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace prismesh::mesh::select {

/// What an item's numbers are ids of.
enum class ItemClass : std::uint8_t { in_hand, node, part, shell, beam, solid, tshell, discrete, mass, sph };
std::string_view name(ItemClass item_class);

struct Item {
  bool remove = false;  ///< `!`
  ItemClass item_class = ItemClass::in_hand;
  bool all = false;        ///< `all`; else the ids first, first + step, ... up to last
  std::int64_t first = 0;  ///< >= 0
  std::int64_t last = 0;   ///< >= first
  std::int64_t step = 1;   ///< >= 1
  std::size_t column = 1;  ///< where the item's name or first number begins, from 1
  std::string_view text;   ///< the item as written, into the expression
};

/// Errors: file "expression", line the column (from 1).
Result<std::vector<Item>> parse(std::string_view expression);

}  // namespace prismesh::mesh::select

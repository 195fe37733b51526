// The grammar of id expressions, apart from what a model makes of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace prismesh::mesh::select {

/// What an item's numbers are ids of; `set` leaves open of which kind the set is.
enum class ItemClass : std::uint8_t {
  in_hand,
  node,
  part,
  shell,
  beam,
  solid,
  tshell,
  discrete,
  mass,
  sph,
  other,
  set,
  node_set,
  shell_set,
  beam_set,
  solid_set,
  tshell_set,
  discrete_set,
  part_set,
  segment_set,
  element_set,
  file
};
inline constexpr int kItemClassCount = 22;
std::string_view name(ItemClass item_class);  ///< "node", "part_set", ...
constexpr bool is_set(ItemClass item_class) { return item_class >= ItemClass::set && item_class <= ItemClass::element_set; }

struct Item {
  ItemClass item_class = ItemClass::in_hand;
  enum class By : std::uint8_t {
    all,         ///< everything of the class
    ids,         ///< first, first + step, ... up to last
    comparison,  ///< every id from first to last, as a comparison says
    other_ids,   ///< every id but `first`
    name,        ///< a set or a file by its name
  } by = By::ids;
  std::int64_t first = 0;  ///< >= 0, but for comparisons
  std::int64_t last = 0;   ///< >= first
  std::int64_t step = 1;   ///< >= 1
  std::string name;        ///< by name
  std::size_t column = 1;  ///< where the item's name or first number begins, from 1
  std::string_view text;   ///< the item as written, into the expression
};

/// What to do with sets on a stack, in order. At the end one set is left.
struct Step {
  enum class Action : std::uint8_t {
    nothing,     ///< push the empty set
    everything,  ///< push all
    push,        ///< push the item's set
    add_item,    ///< the item is added to the topmost set
    take_item,   ///< the item is taken from the topmost set
    add,         ///< take the topmost set off and add it to the one below
    take,        ///< ... take it away from the one below
    meet,        ///< ... leave below what is in both
    complement,  ///< the topmost set becomes all but itself
  } action = Action::nothing;
  std::uint32_t item = 0;
};

struct Parsed {
  std::vector<Item> items;
  std::vector<Step> steps;
};

inline constexpr int kMaxParenthesisDepth = 32;
inline constexpr int kMaxOperators = 1000;  ///< & | ~ ( together; commas are free

/// Errors: file "expression", line the column (from 1).
Result<Parsed> parse(std::string_view expression);

}  // namespace prismesh::mesh::select

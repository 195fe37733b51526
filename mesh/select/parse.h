// Parses id expressions, without a model.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace prismesh::mesh::select {

/// The class of an item's numbers. in_hand: the wanted kind; set: a set of any kind.
enum class ItemClass : std::uint8_t {
  in_hand,
  node,
  part,
  shell,
  quad,  ///< a shell with four corners
  tri,   ///< a shell with three
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
inline constexpr int kItemClassCount = 24;
std::string_view name(ItemClass item_class);  ///< "node", "part_set", ...
constexpr bool is_set(ItemClass item_class) { return item_class >= ItemClass::set && item_class <= ItemClass::element_set; }

struct Item {
  ItemClass item_class = ItemClass::in_hand;
  enum class By : std::uint8_t {
    all,         ///< everything of the class
    ids,         ///< first, first + step, ... up to last
    comparison,  ///< every id from first to last, written as a comparison
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

/// One step of a stack machine for sets. After the last step one set is left.
struct Step {
  enum class Action : std::uint8_t {
    nothing,     ///< push the empty set
    everything,  ///< push all
    push,        ///< push the item's set
    add_item,    ///< the item is added to the topmost set
    take_item,   ///< the item is removed from the topmost set
    add,         ///< pop the topmost set and unite the one below with it
    take,        ///< pop the topmost set and subtract it from the one below
    meet,        ///< pop the topmost set and intersect the one below with it
    complement,  ///< the topmost set becomes its complement
  } action = Action::nothing;
  std::uint32_t item = 0;
};

struct Parsed {
  std::vector<Item> items;
  std::vector<Step> steps;
};

inline constexpr int kMaxParenthesisDepth = 32;
inline constexpr int kMaxOperators = 1000;  ///< & | ~ ( together; commas don't count

/// Parses an expression. Errors: bad syntax, with file "expression" and the column (from 1) as line.
Result<Parsed> parse(std::string_view expression);

}  // namespace prismesh::mesh::select

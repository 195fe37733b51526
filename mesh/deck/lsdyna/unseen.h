// Keywords that make, move or change what is shown in ways that aren't read: each is kept word for word, and told.
#pragma once

#include <optional>
#include <string_view>

namespace prismesh::mesh::deck::lsdyna {

struct Unseen {
  std::string_view kind;     ///< the warning's
  std::string_view message;  ///< goes on after "*KEYWORD "
  bool counted = false;      ///< how many lines there are matters to the user
};

/// Of a block that neither the mesh nor the definitions are read from; `keyword` as in Block::name. nullopt: nothing is lost from view.
std::optional<Unseen> unseen(std::string_view keyword);

}  // namespace prismesh::mesh::deck::lsdyna

// Finds keywords that aren't read and would change what is shown. Their text is kept word for word, and a warning reports them.
#pragma once

#include <optional>
#include <string_view>

namespace prismesh::mesh::deck::lsdyna {

struct Unseen {
  std::string_view kind;     ///< the warning's
  std::string_view message;  ///< goes on after "*KEYWORD "
  bool counted = false;      ///< the warning gives the number of lines
};

/// For a block without mesh or definitions. `keyword`: as Block::name. nullopt: it changes nothing that is shown.
std::optional<Unseen> unseen(std::string_view keyword);

}  // namespace prismesh::mesh::deck::lsdyna

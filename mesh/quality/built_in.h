// The built-in criteria: the texts of mesh/quality/criteria/*.toml, compiled into the program. Private to mesh/quality.
#pragma once

#include <array>
#include <string_view>

namespace prismesh::mesh::quality {

struct BuiltInCriteria {
  std::string_view name;  ///< the file's name without its ending
  std::string_view text;
};
extern const std::array<BuiltInCriteria, 3> kBuiltInCriteria;  ///< the default first

}  // namespace prismesh::mesh::quality

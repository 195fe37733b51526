// The criteria compiled in: the texts of mesh/quality/criteria/*.toml. Inner to quality.
#pragma once

#include <array>
#include <string_view>

namespace prismesh::mesh::quality {

struct BuiltIn {
  std::string_view name;  ///< of the file, without its ending
  std::string_view text;
};
extern const std::array<BuiltIn, 3> kBuiltIn;  ///< the default first

}  // namespace prismesh::mesh::quality

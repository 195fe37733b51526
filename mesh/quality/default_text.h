// The text of mesh/quality/criteria/default.toml, compiled in. Inner to quality.
#pragma once

#include <string_view>

namespace prismesh::mesh::quality {

extern const std::string_view kDefaultCriteriaText;

}  // namespace prismesh::mesh::quality

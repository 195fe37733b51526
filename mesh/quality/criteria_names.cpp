#include "mesh/quality/criteria_names.h"

#include <algorithm>

#include "mesh/quality/built_in.h"

namespace prismesh::mesh::quality {

bool is_built_in_criteria(const std::filesystem::path& name) {
  return std::any_of(kBuiltIn.begin(), kBuiltIn.end(), [&](const BuiltIn& ours) { return name.native() == ours.name; });
}

}  // namespace prismesh::mesh::quality

// Writes ids as an expression.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace prismesh::mesh::report {

/// "1-4,7": an expression that names these ids and no others. `ids`: ascending, each once.
std::string id_list(const std::vector<std::int64_t>& ids);

}  // namespace prismesh::mesh::report

// Which criteria are compiled in, for those who tell a name from a file.
#pragma once

#include <filesystem>

namespace prismesh::mesh::quality {

/// Whether load_criteria takes this for criteria of ours rather than for a file.
bool is_built_in_criteria(const std::filesystem::path& name);

}  // namespace prismesh::mesh::quality

// Writes a count with its noun.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace prismesh {

/// "1 node", "2 nodes": for nouns whose plural takes an s.
std::string counted(std::size_t count, std::string_view noun);

}  // namespace prismesh

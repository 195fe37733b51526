// Finds JSON that is nested too deeply, before it is parsed.
#pragma once

#include <string_view>

namespace prismesh::json {

/// Whether objects and lists stand in each other more than `max_depth` deep. A line of brackets, parsed, takes memory a hundred times its
/// size.
bool is_nested_deeper(std::string_view text, int max_depth);

}  // namespace prismesh::json

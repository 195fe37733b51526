// Writing TOML by hand, so that a user's file keeps its order and comments.
#pragma once

#include <string>
#include <string_view>

namespace prismesh {

/// The text as a basic string of TOML, its quotes included; control characters are escaped.
std::string toml_quoted(std::string_view text);

}  // namespace prismesh

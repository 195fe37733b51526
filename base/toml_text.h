// Writes values of TOML. Files are changed as text, so that they keep their order and comments.
#pragma once

#include <string>
#include <string_view>

namespace prismesh {

/// The text as a basic string of TOML, with its quotes; control characters are escaped.
std::string toml_quoted(std::string_view text);

}  // namespace prismesh

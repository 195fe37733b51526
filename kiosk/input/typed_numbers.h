// Numbers that are typed: how text becomes numbers.
#pragma once

#include <string_view>
#include <vector>

#include "base/error.h"

namespace prismesh::kiosk::input {

/// One or more numbers, with spaces, commas or semicolons between them. Errors: a sentence for what is none (file and line empty).
Result<std::vector<double>> parse_numbers(std::string_view text);

/// Nothing was typed but spaces.
inline bool is_blank(std::string_view text) { return text.find_first_not_of(' ') == std::string_view::npos; }

}  // namespace prismesh::kiosk::input

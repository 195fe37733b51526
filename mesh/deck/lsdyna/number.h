// Numbers as they stand in the fields of a card: Fortran's forms besides the usual ones. Blank means zero.
#pragma once

#include <cstdint>
#include <string_view>

namespace prismesh::mesh::deck::lsdyna {

/// "-1.5", "1.5e-3", "1.D0", "1.5-3" (an exponent without its letter), "+7", ".5", "7."; blanks around it are skipped.
/// Correctly rounded. False: it isn't a number, or is too large for one.
bool parse_real(std::string_view field, double& value);

/// A whole number; "12." and "1.2E1" count as one. False: it isn't a whole number, or has more than 18 digits.
bool parse_integer(std::string_view field, std::int64_t& value);

/// Without the blanks around it.
std::string_view trim(std::string_view text);

}  // namespace prismesh::mesh::deck::lsdyna

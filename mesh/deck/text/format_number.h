// Writes a coordinate as the text of a field.
#pragma once

#include <string>

namespace prismesh::mesh::deck {

/// How an exponent is written: 1.5E-3, or 1.5-3, which only Nastran reads.
enum class Exponent { with_letter, bare };

/// The shortest text of at most `width` characters that reads back as `value`; if there is none, the most precise that fits. It always
/// has a decimal point, which solvers need.
std::string format_coordinate(double value, std::size_t width, Exponent exponent = Exponent::with_letter);

}  // namespace prismesh::mesh::deck

// A coordinate as the text of a field.
#pragma once

#include <string>

namespace prismesh::mesh::deck::lsdyna {

/// The shortest text of at most `width` characters that reads back as `value`; where there is none, the most precise that
/// fits. Always with a decimal point, as solvers want it.
std::string format_coordinate(double value, std::size_t width);

}  // namespace prismesh::mesh::deck::lsdyna

// Text and numbers as reports show them.
#pragma once

#include <string>
#include <string_view>

namespace prismesh::mesh::report {

/// Replaces control characters and bytes that aren't UTF-8 by \xNN, for terminals and JSON.
std::string printable(std::string_view text);

/// The double that has a float's shortest digits: 8.07f as 8.07, not 8.06999969482422.
double as_written(float value);

}  // namespace prismesh::mesh::report

// Counts the lines that differ between two texts.
#pragma once

#include <cstddef>
#include <string_view>

namespace prismesh::mesh::report {

/// Counts the lines that were changed, added or removed. Method: patience diff. Lines that occur once in each text are matched first, by
/// the longest subsequence that keeps their order; between matches a changed line and a surplus line count as one each. Lines end with LF;
/// a last line without it differs from the same line with it.
std::size_t lines_changed(std::string_view a, std::string_view b);

}  // namespace prismesh::mesh::report

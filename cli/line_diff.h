// How many lines differ between two texts. Inner to cli.
#pragma once

#include <cstddef>
#include <string_view>

namespace prismesh::cli {

/// Lines changed, added or removed. Lines that occur once in each text are matched first, in the longest run that keeps their
/// order (patience diff); between matches a line for a line counts as one change, surplus lines one each.
/// Lines end with LF; a last line without one differs from the same line with it.
std::size_t lines_changed(std::string_view a, std::string_view b);

}  // namespace prismesh::cli

// Reads and writes lines and columns of a starter deck's text, and finds the lines of lists.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/model/references.h"

namespace prismesh::mesh::deck::radioss {

inline constexpr std::size_t kIdsPerLine = 10;  ///< of a list

/// One past the last character of the line that holds `offset`, and that line from there on.
std::size_t end_of_line(std::string_view text, std::size_t offset);
std::string_view line_at(std::string_view text, std::size_t offset);

/// The line end at `end`. At the end of the text, where it is missing, the one that the text uses.
std::string line_end_at(std::string_view text, std::size_t end);

/// The line with each tab replaced by one blank.
std::string without_tabs(std::string_view line);

/// Puts a number into columns: aligned left if the old number was, else right.
void put(std::string& line, std::size_t begin, std::size_t width, std::string_view number);

/// The width of a field in a card's lines.
std::size_t width_of(const Referrer& card);

/// A line of a set.
struct ListLine {
  std::string_view text;
  std::size_t offset = 0;
};
/// The title's line, then the lines that aren't blank.
std::vector<ListLine> list_lines(std::string_view text, const Referrer& set);

}  // namespace prismesh::mesh::deck::radioss

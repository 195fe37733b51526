// Lines of a deck's text. Private to mesh/deck.
#pragma once

#include <cstddef>
#include <string_view>

namespace prismesh::mesh::deck {

/// Lines that come, go or change: what is alike at both ends doesn't count.
std::size_t lines_that_differ(std::string_view before, std::string_view after);

/// What follows the line at `at`: "\n" or "\r\n"; at the end of the text that of the line before it.
std::string_view line_end(std::string_view text, std::size_t at);

}  // namespace prismesh::mesh::deck

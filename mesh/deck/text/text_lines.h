// Finds and compares lines and blocks of a deck's text. Private to mesh/deck.
#pragma once

#include <cstddef>
#include <map>
#include <string_view>
#include <tuple>

namespace prismesh::mesh::deck {

/// The number of lines that are added, removed or changed. Equal lines at both ends don't count.
std::size_t lines_that_differ(std::string_view before, std::string_view after);

/// The line end behind `at`: "\n" or "\r\n"; in a last line without one, that of the line before.
std::string_view line_end(std::string_view text, std::size_t at);

/// Finds the blocks of cards. Searches once for each block, however many of its cards are asked for.
class BlockFinder {
 public:
  struct BlockRange {
    std::size_t keyword = 0;   ///< offset of its keyword's line; 0 without a keyword
    std::size_t end = 0;       ///< offset of the next keyword's line, or of the text's end
    bool has_keyword = false;  ///< false: the lines stand at the text's beginning, before any keyword
  };
  /// Whether the line that begins at `line` is a keyword's.
  using IsKeyword = bool (*)(std::string_view text, std::size_t line);
  explicit BlockFinder(IsKeyword is_keyword) : is_keyword_(is_keyword) {}
  /// The block of the line that begins at `line`. `text` must stay in memory, at its address, as long as this lives.
  BlockRange at(std::string_view text, std::size_t line);

 private:
  IsKeyword is_keyword_;
  std::map<std::tuple<const char*, std::size_t, std::size_t>, BlockRange> known_;  ///< by text, its size and the keyword's place
};

}  // namespace prismesh::mesh::deck

// Lines of a deck's text. Private to mesh/deck.
#pragma once

#include <cstddef>
#include <map>
#include <string_view>
#include <tuple>

namespace prismesh::mesh::deck {

/// Lines that come, go or change: what is alike at both ends doesn't count.
std::size_t lines_that_differ(std::string_view before, std::string_view after);

/// What follows the line at `at`: "\n" or "\r\n"; at the end of the text that of the line before it.
std::string_view line_end(std::string_view text, std::size_t at);

/// Finds the blocks that cards stand in. Each is looked for once, however many of its cards are asked for.
class BlockFinder {
 public:
  struct BlockRange {
    std::size_t keyword = 0;   ///< where its keyword's line begins; 0 where there is none
    std::size_t end = 0;       ///< where the next keyword's line begins, or the text ends
    bool has_keyword = false;  ///< false: the lines stand at the text's beginning without one
  };
  /// Whether the line that begins at an offset is a keyword's.
  using IsKeyword = bool (*)(std::string_view text, std::size_t line);
  explicit BlockFinder(IsKeyword is_keyword) : is_keyword_(is_keyword) {}
  /// `text` must stay where it is for as long as this lives; `line` begins a line.
  BlockRange at(std::string_view text, std::size_t line);

 private:
  IsKeyword is_keyword_;
  std::map<std::tuple<const char*, std::size_t, std::size_t>, BlockRange> known_;  ///< by text, its size and the keyword's place
};

}  // namespace prismesh::mesh::deck

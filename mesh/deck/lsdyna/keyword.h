// Cuts a file into keyword blocks. Interprets only where each block starts and how its columns are cut.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/deck/data/deck.h"

namespace prismesh::mesh::deck::lsdyna {

/// How the columns of a run of cards are cut. A card with commas is free format in any layout. Part of CardRun::style.
enum class Columns : std::uint8_t { standard, i10, wide };

/// From a line that starts with '*' to the next one. Offsets are into the file's text.
struct Block {
  std::string name;  ///< upper case, without the asterisk, the suffix and what follows: "ELEMENT_SHELL_THICKNESS"
  Columns columns = Columns::standard;
  std::size_t keyword = 0;  ///< of the '*'
  std::size_t begin = 0;    ///< of the first line after the keyword
  std::size_t end = 0;
};

/// Walks over the blocks of a file up to *END.
class Blocks {
 public:
  /// `columns` apply until a *KEYWORD line gives others.
  Blocks(std::string_view text, Columns columns) : text_(text), columns_(columns) {}
  bool next(Block& block);
  /// After next() returned false: whether the file has *END.
  bool ended() const { return ended_; }
  /// As the *KEYWORD lines so far give them.
  Columns columns() const { return columns_; }

 private:
  std::size_t find_keyword(std::size_t at) const;

  std::string_view text_;
  Columns columns_;
  std::size_t at_ = 0;
  bool started_ = false;
  bool ended_ = false;
};

/// A line without its end, and the offset of its start.
struct Line {
  std::string_view text;
  std::size_t offset = 0;
};

/// Walks over the data lines of a range. Skips comments and cuts off line ends (LF or CRLF). Blank lines are data.
class Lines {
 public:
  Lines(std::string_view text, std::size_t begin, std::size_t end) : text_(text.substr(0, end)), at_(begin) {}
  /// False at the end of the range.
  bool next(Line& line);

 private:
  std::string_view text_;
  std::size_t at_;
};

/// Whether `keyword` contains `word` as a whole word or words between underscores.
bool has_word(std::string_view keyword, std::string_view word);

/// The begin of the lines before and behind an encrypted block.
inline constexpr std::string_view kEncryptedBegin = "-----BEGIN PGP";
inline constexpr std::string_view kEncryptedEnd = "-----END PGP";

}  // namespace prismesh::mesh::deck::lsdyna

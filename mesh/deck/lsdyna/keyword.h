// A file cut into keyword blocks. Nothing is interpreted here but where each block starts and how its columns are cut.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/deck/data/deck.h"

namespace prismesh::mesh::deck::lsdyna {

/// How the columns of a run of cards are cut (a card with commas is free format whatever the layout). CardRun::style of this format.
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
  /// `columns` is what holds where no *KEYWORD line says otherwise.
  Blocks(std::string_view text, Columns columns) : text_(text), columns_(columns) {}
  bool next(Block& block);
  /// Once next() is false: whether *END was there.
  bool ended() const { return ended_; }
  /// What the *KEYWORD lines so far say.
  Columns columns() const { return columns_; }

 private:
  std::size_t find_keyword(std::size_t at) const;

  std::string_view text_;
  Columns columns_;
  std::size_t at_ = 0;
  bool started_ = false;
  bool ended_ = false;
};

/// A line without its end, and where it starts.
struct Line {
  std::string_view text;
  std::size_t offset = 0;
};

/// Walks over the data lines of a range: comments are skipped, line ends (LF or CRLF) cut off. Blank lines are data.
class Lines {
 public:
  Lines(std::string_view text, std::size_t begin, std::size_t end) : text_(text.substr(0, end)), at_(begin) {}
  /// False at the end of the range.
  bool next(Line& line);

 private:
  std::string_view text_;
  std::size_t at_;
};

/// Whether a whole word of `keyword`, between underscores, is `word`.
bool has_word(std::string_view keyword, std::string_view word);

/// What stands before an encrypted block, at the start of a line.
inline constexpr std::string_view kEncryptedBegin = "-----BEGIN PGP";
inline constexpr std::string_view kEncryptedEnd = "-----END PGP";

}  // namespace prismesh::mesh::deck::lsdyna

// Keyword blocks of the starter input: a line that begins with a slash, and the lines up to the next one, wherever includes bring them in.
// Source: Radioss Reference Guide, "Starter Keywords Syntax" and "#include".
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/deck/data/deck.h"

namespace prismesh::mesh::deck::radioss {

/// Every layout is made of fields of one width; a real number takes two of them. Input of versions before 51 has 8 columns a field.
inline constexpr std::size_t kField = 10;
inline constexpr std::size_t kOldField = 8;
inline constexpr std::int64_t kFirstWideVersion = 51;

/// Text of one file that belongs to a block.
struct Stretch {
  std::uint32_t file = 0;
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// A block's keyword line and where its lines are.
struct Block {
  std::uint32_t file = 0;
  std::uint32_t context = 0;  ///< the submodel it stands in, as Contexts number them
  std::size_t offset = 0;     ///< of the slash
  Stretch body;               ///< of the file with the keyword
  std::vector<Stretch> more;  ///< where includes stand in the middle of the block: all that follows
};

/// "/GRNOD/NODE/12/3" -> words GRNOD, NODE and numbers 12, 3. Words are in upper case, without those after the first number.
struct Keyword {
  std::vector<std::string> words;
  std::vector<std::int64_t> numbers;

  std::string_view word(std::size_t i) const { return i < words.size() ? std::string_view(words[i]) : std::string_view(); }
  /// 0: there is none.
  std::int64_t number(std::size_t i) const { return i < numbers.size() ? numbers[i] : 0; }
  std::string joined() const;  ///< "GRNOD/NODE"
};
Keyword keyword_at(std::string_view text, std::size_t offset);

/// A line without its end, and where it is.
struct Line {
  std::string_view text;
  std::uint32_t file = 0;
  std::size_t offset = 0;
};

/// Whether a text begins with "#include" in any letters, with a blank behind it.
bool is_include(std::string_view text);
/// What begins with this line isn't read.
inline constexpr std::string_view kEndOfData = "#enddata";

/// Walks over the data lines of a stretch: comments are skipped, line ends (LF or CRLF) cut off. Blank lines are data.
class Lines {
 public:
  Lines(std::string_view file_text, std::size_t begin, std::size_t end) : text_(file_text.substr(0, end)), at_(begin) {}
  bool next(std::string_view& line, std::size_t& offset);

 private:
  std::string_view text_;
  std::size_t at_;
};

/// The data lines of a block, whatever files they stand in.
class BlockLines {
 public:
  BlockLines(std::span<const SourceFile> files, const Block& block) : files_(files), block_(block) { enter(0); }
  bool next(Line& line);

 private:
  void enter(std::size_t stretch);

  std::span<const SourceFile> files_;
  const Block& block_;
  std::size_t stretch_ = 0;
  std::optional<Lines> lines_;
  std::uint32_t file_ = 0;
};

/// `count` fields from field `first` (from 0) on; shorter where the line ends.
inline std::string_view field(std::string_view line, std::size_t width, std::size_t first, std::size_t count = 1) {
  return line.substr(std::min(first * width, line.size()), count * width);
}

}  // namespace prismesh::mesh::deck::radioss

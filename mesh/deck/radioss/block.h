// Reads keyword blocks of the starter input: a line that begins with a slash and the lines up to the next one, also those of includes.
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

/// The widths of a field. A real number takes two fields. Input of versions before 51 has 8 columns a field.
inline constexpr std::size_t kField = 10;
inline constexpr std::size_t kOldField = 8;
inline constexpr std::int64_t kFirstWideVersion = 51;

/// Text of one file that belongs to a block.
struct Stretch {
  std::uint32_t file = 0;
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// Where a block's keyword and lines stand.
struct Block {
  std::uint32_t file = 0;
  std::uint32_t context = 0;  ///< the submodel it stands in: index into the contexts
  std::size_t offset = 0;     ///< of the slash
  Stretch body;               ///< in the file with the keyword
  std::vector<Stretch> more;  ///< the rest, where includes stand in the middle of the block
};

/// A keyword line: "/GRNOD/NODE/12/3" has the words GRNOD, NODE and the numbers 12, 3. Words are in upper case; words behind the first
/// number are left out.
struct Keyword {
  std::vector<std::string> words;
  std::vector<std::int64_t> numbers;

  std::string_view word(std::size_t i) const { return i < words.size() ? std::string_view(words[i]) : std::string_view(); }
  /// The number; 0: there is none.
  std::int64_t number(std::size_t i) const { return i < numbers.size() ? numbers[i] : 0; }
  std::string joined() const;  ///< "GRNOD/NODE"
};
Keyword keyword_at(std::string_view text, std::size_t offset);

/// A line without its end, and where it begins.
struct Line {
  std::string_view text;
  std::uint32_t file = 0;
  std::size_t offset = 0;
};

/// Whether a text begins with "#include", in any case, and a blank.
bool is_include(std::string_view text);
/// From this line on nothing is read.
inline constexpr std::string_view kEndOfData = "#enddata";

/// Walks over the data lines of a stretch. Skips comments and cuts off line ends (LF or CRLF). Blank lines are data.
class Lines {
 public:
  Lines(std::string_view file_text, std::size_t begin, std::size_t end) : text_(file_text.substr(0, end)), at_(begin) {}
  bool next(std::string_view& line, std::size_t& offset);

 private:
  std::string_view text_;
  std::size_t at_;
};

/// Walks over the data lines of a block, in all its files.
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

/// The text of `count` fields from field `first` (from 0) on. Shorter if the line ends before.
inline std::string_view field(std::string_view line, std::size_t width, std::size_t first, std::size_t count = 1) {
  return line.substr(std::min(first * width, line.size()), count * width);
}

}  // namespace prismesh::mesh::deck::radioss

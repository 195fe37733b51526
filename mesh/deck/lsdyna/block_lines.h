// The data lines of a block around its encrypted parts.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "mesh/deck/lsdyna/keyword.h"

namespace prismesh::mesh::deck::lsdyna {

/// From the line that begins an encrypted part to behind the line that ends it. Offsets are into the file's text.
struct EncryptedPart {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// The encrypted parts of text[begin, end), ascending. One without an end goes on to `end`.
std::vector<EncryptedPart> encrypted_parts(std::string_view text, std::size_t begin, std::size_t end);

/// Walks over the data lines of text[begin, end) as if the encrypted parts weren't there. A copy goes on from where it was made.
class BlockLines {
 public:
  /// `encrypted` must outlive this.
  BlockLines(std::string_view text, std::size_t begin, std::size_t end, const std::vector<EncryptedPart>& encrypted)
      : text_(text), end_(end), encrypted_(&encrypted), lines_(text, begin, encrypted.empty() ? end : encrypted.front().begin) {}
  /// False at the end of the block.
  bool next(Line& line);

 private:
  std::string_view text_;
  std::size_t end_;
  const std::vector<EncryptedPart>* encrypted_;
  std::size_t passed_ = 0;  ///< encrypted parts before lines_
  Lines lines_;
};

}  // namespace prismesh::mesh::deck::lsdyna

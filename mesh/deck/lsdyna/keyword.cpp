#include "mesh/deck/lsdyna/keyword.h"

#include <algorithm>
#include <cstring>

#include "base/letter_case.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::lsdyna {
namespace {

constexpr std::size_t kMaxKeywordLength = 256;
constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

std::size_t line_feed_at(std::string_view text, std::size_t at) {
  const void* found = std::memchr(text.data() + at, '\n', text.size() - at);
  return found ? static_cast<std::size_t>(static_cast<const char*>(found) - text.data()) : text.size();
}

/// The value of NAME=VALUE in the rest of a *KEYWORD line; blanks around the sign are allowed. 0 if it isn't there.
char option(std::string_view rest, std::string_view name) {
  const std::size_t at = rest.find(name);
  if (at == std::string_view::npos) return 0;
  rest = trim(rest.substr(at + name.size()));
  if (rest.empty() || rest.front() != '=') return 0;
  rest = trim(rest.substr(1));
  return rest.empty() ? char{0} : rest.front();
}

/// LONG=Y and K: the deck is wide; S: only what the solver writes is. I10=Y: eight-column fields have ten.
void read_keyword_options(std::string_view rest, Columns& columns) {
  const char wide = option(rest, "LONG");
  const char i10 = option(rest, "I10");
  if (wide == 'Y' || wide == 'K')
    columns = Columns::wide;
  else if (i10 == 'Y')
    columns = Columns::i10;
  else if (wide == 'S' || wide == 'N' || i10 == 'N')
    columns = Columns::standard;
}

/// Name and columns from a keyword line; `columns` holds what the *KEYWORD line said.
Block read_keyword(std::string_view line, Columns& columns) {
  Block block;
  line = trim(line.substr(1)).substr(0, kMaxKeywordLength);
  const std::string text = upper(line);
  std::size_t length = 0;
  while (length < text.size() && text[length] != ' ' && text[length] != '\t' && text[length] != ',') ++length;
  block.name = text.substr(0, length);
  const std::string_view rest = trim(std::string_view(text).substr(length));
  if (block.name.rfind("KEYWORD", 0) == 0) read_keyword_options(rest, columns);
  block.columns = columns;
  // "*NODE+", "*NODE +"
  char suffix = block.name.empty() ? char{0} : block.name.back();
  if (suffix == '%' || suffix == '+' || suffix == '-')
    block.name.pop_back();
  else
    suffix = rest.empty() ? char{0} : rest.front();
  if (suffix == '%') block.columns = Columns::i10;
  if (suffix == '+') block.columns = Columns::wide;
  if (suffix == '-') block.columns = Columns::standard;
  return block;
}

}  // namespace

bool has_word(std::string_view keyword, std::string_view word) {
  for (std::size_t at = keyword.find(word); at != std::string_view::npos; at = keyword.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    if ((at == 0 || keyword[at - 1] == '_') && (end == keyword.size() || keyword[end] == '_')) return true;
  }
  return false;
}

std::size_t Blocks::find_keyword(std::size_t at) const {
  // Asterisks are rare: looking for them is much faster than looking at every line.
  while (at < text_.size()) {
    const void* found = std::memchr(text_.data() + at, '*', text_.size() - at);
    if (!found) break;
    at = static_cast<std::size_t>(static_cast<const char*>(found) - text_.data());
    if (at == 0 || text_[at - 1] == '\n') return at;
    // Some editors put a byte order mark before the first keyword.
    if (at == kByteOrderMark.size() && text_.substr(0, at) == kByteOrderMark) return at;
    ++at;
  }
  return text_.size();
}

bool Blocks::next(Block& block) {
  if (!started_) at_ = find_keyword(0);
  started_ = true;
  if (ended_ || at_ >= text_.size()) return false;
  const std::size_t end = line_feed_at(text_, at_);
  block = read_keyword(text_.substr(at_, end - at_), columns_);
  block.keyword = at_;
  block.begin = std::min(end + 1, text_.size());
  ended_ = block.name == "END";
  if (ended_) return false;
  at_ = find_keyword(block.begin);
  block.end = at_;
  return true;
}

bool Lines::next(Line& line) {
  while (at_ < text_.size()) {
    const std::size_t begin = at_;
    const std::size_t end = line_feed_at(text_, begin);
    at_ = end + 1;
    if (text_[begin] == '$') continue;
    line.text = text_.substr(begin, end - begin);
    if (!line.text.empty() && line.text.back() == '\r') line.text.remove_suffix(1);
    line.offset = begin;
    return true;
  }
  return false;
}

}  // namespace prismesh::mesh::deck::lsdyna

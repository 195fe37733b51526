#include "mesh/deck/radioss/block.h"

#include <algorithm>

#include "base/letter_case.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::radioss {
namespace {

constexpr std::size_t kMaxKeywordLength = 200;
constexpr std::size_t kMaxWords = 12;

bool is_comment(char first) { return first == '#' || first == '$'; }

}  // namespace

std::string Keyword::joined() const {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : "/") + word;
  return out;
}

Keyword keyword_at(std::string_view text, std::size_t offset) {
  Keyword out;
  std::string_view line = text.substr(offset, std::min(text.find_first_of("\r\n", offset), text.size()) - offset);
  line = trim(line.substr(0, kMaxKeywordLength));
  while (!line.empty() && line.front() == '/' && out.words.size() + out.numbers.size() < kMaxWords) {
    line.remove_prefix(1);
    const std::string_view part = trim(line.substr(0, line.find('/')));
    line.remove_prefix(std::min(line.find('/'), line.size()));
    std::int64_t number = 0;
    if (!part.empty() && part.find_first_not_of("0123456789") == std::string_view::npos && parse_integer(part, number)) {
      out.numbers.push_back(number);
    } else if (out.numbers.empty() && !part.empty()) {
      out.words.push_back(upper(part));
    }
  }
  return out;
}

bool is_include(std::string_view text) {
  constexpr std::string_view kWord = "#include";
  if (text.size() <= kWord.size() || (text[kWord.size()] != ' ' && text[kWord.size()] != '\t')) return false;
  return std::equal(kWord.begin(), kWord.end(), text.begin(), [](char a, char b) { return a == lower(b); });
}

bool Lines::next(std::string_view& line, std::size_t& offset) {
  while (at_ < text_.size()) {
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    offset = at_;
    at_ = end + 1;
    if (is_comment(text_[offset])) continue;
    line = text_.substr(offset, end - offset);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    return true;
  }
  return false;
}

void BlockLines::enter(std::size_t stretch) {
  stretch_ = stretch;
  const Stretch& at = stretch == 0 ? block_.body : block_.more[stretch - 1];
  file_ = at.file;
  lines_.emplace(files_[at.file].bytes.text(), at.begin, at.end);
}

bool BlockLines::next(Line& line) {
  while (!lines_->next(line.text, line.offset)) {
    if (stretch_ == block_.more.size()) return false;
    enter(stretch_ + 1);
  }
  line.file = file_;
  return true;
}

}  // namespace prismesh::mesh::deck::radioss

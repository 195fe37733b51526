#include "mesh/deck/abaqus/keyword.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "base/letter_case.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::abaqus {
namespace {

bool blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

std::size_t next_line(std::string_view text, std::size_t at) {
  const std::size_t end = text.find('\n', at);
  return end == std::string_view::npos ? text.size() : end + 1;
}

/// Where a keyword line that begins at `at` ends: after a comma it continues in the next line.
std::size_t keyword_end(std::string_view text, std::size_t at) {
  for (;;) {
    const std::size_t end = next_line(text, at);
    std::string_view line = text.substr(at, end - at);
    while (!line.empty() && (blank(line.back()) || line.back() == '\n')) line.remove_suffix(1);
    const std::string_view shown = trim(line);
    const bool comment = shown.substr(0, 2) == "**";
    if (end >= text.size() || (!comment && (line.empty() || line.back() != ','))) return end;
    // A keyword after a comma begins a line of its own all the same.
    const std::string_view after = trim(text.substr(end, std::min<std::size_t>(text.size() - end, 256)));
    if (!after.empty() && after[0] == '*' && after.substr(0, 2) != "**") return end;
    at = end;
  }
}

std::string keyword_name(std::string_view line) {
  std::string name;
  for (const char c : line.substr(0, 200)) {
    if (c == ',' || c == '\n') break;
    if (!blank(c))
      name += upper(c);
    else if (!name.empty() && name.back() != ' ')
      name += ' ';
  }
  while (!name.empty() && name.back() == ' ') name.pop_back();
  return name;
}

std::string_view unquoted(std::string_view value) {
  if (value.size() >= 2 && value.front() == value.back() && (value.front() == '"' || value.front() == '\''))
    return value.substr(1, value.size() - 2);
  return value;
}

}  // namespace

bool Keywords::next(Keyword& keyword) {
  while (at_ < text_.size()) {
    const auto* found = static_cast<const char*>(std::memchr(text_.data() + at_, '*', text_.size() - at_));
    if (!found) break;
    const auto star = static_cast<std::size_t>(found - text_.data());
    std::size_t begin = star;
    while (begin > at_ && (text_[begin - 1] == ' ' || text_[begin - 1] == '\t')) --begin;
    const bool starts_line = begin == 0 || text_[begin - 1] == '\n' || (begin == 3 && text_.substr(0, 3) == "\xef\xbb\xbf");
    if (!starts_line) {
      at_ = star + 1;
      continue;
    }
    if (star + 1 < text_.size() && text_[star + 1] == '*') {
      at_ = next_line(text_, star);
      continue;
    }
    keyword.begin = begin;
    keyword.name = keyword_name(text_.substr(star + 1));
    keyword.end = at_ = keyword_end(text_, star);
    return true;
  }
  at_ = text_.size();
  return false;
}

Parameters::Parameters(std::string_view text, std::size_t begin, std::size_t end) {
  std::size_t at = std::min(text.find('*', begin), end);
  bool first = true;
  while (at < end) {
    const std::size_t line_end = std::min(next_line(text, at), end);
    const std::string_view line = text.substr(at, line_end - at);
    at = line_end;
    if (!first && trim(line).substr(0, 2) == "**") continue;
    std::size_t field = 0;
    while (field < line.size()) {
      // A comma between quotes belongs to the value.
      std::size_t stop = field;
      char quote = 0;
      for (; stop < line.size() && (quote != 0 || line[stop] != ','); ++stop)
        if (line[stop] == '"' || line[stop] == '\'') quote = quote == 0 ? line[stop] : quote == line[stop] ? char{0} : quote;
      std::string_view entry = line.substr(field, stop - field);
      field = stop + 1;
      if (std::exchange(first, false)) continue;
      while (!entry.empty() && entry.back() == '\n') entry.remove_suffix(1);
      const std::size_t equals = entry.find('=');
      std::string name;
      for (const char c : entry.substr(0, std::min<std::size_t>(equals, 100)))
        if (!blank(c)) name += upper(c);
      if (name.empty()) continue;
      const std::string_view value = equals == std::string_view::npos ? std::string_view() : unquoted(trim(entry.substr(equals + 1)));
      entries_.emplace_back(std::move(name), std::string(value));
    }
  }
}

std::optional<std::string> Parameters::value(std::string_view name) const {
  for (const auto& [own, text] : entries_)
    if (own == name) return text;
  return std::nullopt;
}

std::string label(std::string_view name) {
  std::string out(unquoted(trim(name)));
  for (char& c : out) c = upper(c);
  return out;
}

bool DataLines::next(DataLine& line) {
  while (at_ < end_) {
    const auto* found = static_cast<const char*>(std::memchr(text_.data() + at_, '\n', end_ - at_));
    const std::size_t stop = found ? static_cast<std::size_t>(found - text_.data()) : end_;
    line.offset = at_;
    line.text = text_.substr(at_, stop - at_);
    at_ = std::min(stop + 1, end_);
    while (!line.text.empty() && blank(line.text.back())) line.text.remove_suffix(1);
    if (line.text.empty()) continue;
    const std::size_t first = line.text.find_first_not_of(" \t");
    if (line.text.substr(first, 2) == "**") continue;
    return true;
  }
  return false;
}

bool Fields::next(std::string_view& field) {
  if (rest_.empty()) return false;
  const std::size_t comma = std::min(rest_.find(','), rest_.size());
  field = trim(rest_.substr(0, comma));
  rest_.remove_prefix(std::min(comma + 1, rest_.size()));
  return true;
}

}  // namespace prismesh::mesh::deck::abaqus

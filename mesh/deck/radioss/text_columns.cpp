#include "mesh/deck/radioss/text_columns.h"

#include <algorithm>

#include "mesh/deck/radioss/block.h"
#include "mesh/deck/radioss/references.h"

namespace prismesh::mesh::deck::radioss {

std::size_t end_of_line(std::string_view text, std::size_t offset) {
  const std::size_t end = std::min(text.find('\n', offset), text.size());
  return end > offset && text[end - 1] == '\r' ? end - 1 : end;
}

std::string_view line_at(std::string_view text, std::size_t offset) { return text.substr(offset, end_of_line(text, offset) - offset); }

std::string without_tabs(std::string_view line) {
  std::string out(line);
  std::replace(out.begin(), out.end(), '\t', ' ');
  return out;
}

void put(std::string& line, std::size_t begin, std::size_t width, std::string_view number) {
  if (line.size() < begin + width) line.resize(begin + width, ' ');
  const std::string_view old = std::string_view(line).substr(begin, width);
  const std::size_t first = old.find_first_not_of(' ');
  const bool leans_left = first <= 1 && old.back() == ' ' && first + number.size() < width;
  std::string out(width, ' ');
  std::copy(number.begin(), number.end(),
            out.begin() + static_cast<std::ptrdiff_t>(leans_left ? first : width - std::min(width, number.size())));
  line.replace(begin, width, out);
}

std::size_t width_of(const Referrer& set) { return is_old(set.style) ? kOldField : kField; }

std::string line_end_at(std::string_view text, std::size_t end) {
  if (end < text.size()) return text[end] == '\r' ? "\r\n" : "\n";
  return text.find("\r\n") != std::string_view::npos ? "\r\n" : "\n";
}

std::vector<ListLine> list_lines(std::string_view text, const Referrer& set) {
  std::vector<ListLine> out;
  const std::size_t first = std::min(text.find('\n', set.offset), text.size());
  Lines lines(text, std::min(first + 1, text.size()), std::min<std::size_t>(set.end, text.size()));
  ListLine line;
  if (!lines.next(line.text, line.offset)) return out;
  out.push_back(line);  // new ids go behind it if the list is empty
  while (lines.next(line.text, line.offset))
    if (line.text.find_first_not_of(" \t") != std::string_view::npos) out.push_back(line);
  return out;
}

}  // namespace prismesh::mesh::deck::radioss

#include "mesh/deck/text/text_lines.h"

#include <algorithm>
#include <iterator>
#include <vector>

namespace prismesh::mesh::deck {
namespace {

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    lines.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

}  // namespace

std::size_t lines_that_differ(std::string_view before, std::string_view after) {
  // Behind a last line without an end, the end that it gets makes no line of its own.
  if (before.empty()) after.remove_prefix(std::min(after.find_first_not_of("\r\n"), after.size()));
  const std::vector<std::string_view> a = lines_of(before), b = lines_of(after);
  if (a.size() == b.size()) {
    std::size_t differ = 0;
    for (std::size_t i = 0; i < a.size(); ++i) differ += a[i] != b[i];
    return differ;
  }
  const std::size_t common = std::min(a.size(), b.size());
  std::size_t front = 0, back = 0;
  while (front < common && a[front] == b[front]) ++front;
  while (back < common - front && a[a.size() - 1 - back] == b[b.size() - 1 - back]) ++back;
  return std::max(a.size(), b.size()) - front - back;
}

std::string_view line_end(std::string_view text, std::size_t at) {
  std::size_t newline = text.find('\n', at);
  if (newline == std::string_view::npos) newline = text.rfind('\n');
  return newline != std::string_view::npos && newline > 0 && text[newline - 1] == '\r' ? "\r\n" : "\n";
}

BlockFinder::BlockRange BlockFinder::at(std::string_view text, std::size_t line) {
  const auto after = known_.upper_bound({text.data(), text.size(), line});
  if (after != known_.begin()) {
    const auto& [place, block] = *std::prev(after);
    if (std::get<0>(place) == text.data() && std::get<1>(place) == text.size() && line < block.end) return block;
  }
  BlockRange block;
  for (block.keyword = line; block.keyword > 0 && !is_keyword_(text, block.keyword);) {
    const std::size_t newline = block.keyword < 2 ? std::string_view::npos : text.rfind('\n', block.keyword - 2);
    block.keyword = newline == std::string_view::npos ? 0 : newline + 1;
  }
  block.has_keyword = block.keyword < text.size() && is_keyword_(text, block.keyword);
  for (block.end = line; block.end < text.size() && (block.end == line || !is_keyword_(text, block.end));)
    block.end = std::min(text.find('\n', block.end), text.size() - 1) + 1;
  return known_[{text.data(), text.size(), block.keyword}] = block;
}

}  // namespace prismesh::mesh::deck

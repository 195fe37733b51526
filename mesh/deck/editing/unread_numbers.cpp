#include "mesh/deck/editing/unread_numbers.h"

#include <algorithm>
#include <set>

#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck {
namespace {

/// Words longer than this may be fields that touch each other.
constexpr std::size_t kNarrowestField = 8;

bool separates(char c) {
  return c == ' ' || c == ',' || c == '\t' || c == '\r' || c == '\n' || c == '(' || c == ')' || c == '=' || c == ':' || c == ';' ||
         c == '/';
}

void add_number(std::string_view word, std::vector<std::int64_t>& numbers) {
  std::int64_t value = 0;
  if (word.empty() || !parse_integer(word, value) || value == 0) return;
  numbers.push_back(value < 0 ? -value : value);
}

void gather_of_line(std::string_view line, std::vector<std::int64_t>& numbers) {
  std::size_t longest = 0;
  for (std::size_t at = 0; at < line.size();) {
    std::size_t end = at;
    while (end < line.size() && !separates(line[end])) ++end;
    if (end > at) {
      add_number(line.substr(at, end - at), numbers);
      longest = std::max(longest, end - at);
    }
    at = end + 1;
  }
  if (longest <= kNarrowestField) return;
  for (const std::size_t width : {std::size_t{8}, std::size_t{10}, std::size_t{16}, std::size_t{20}})
    for (std::size_t at = 0; at < line.size(); at += width) add_number(trim(line.substr(at, width)), numbers);
}

}  // namespace

void gather_whole_numbers(std::string_view text, std::vector<std::int64_t>& numbers) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    gather_of_line(text.substr(0, end), numbers);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

void UnreadNumbers::gather() {
  if (numbers_) return;
  numbers_.emplace();
  std::vector<std::int64_t> found;
  const auto unread = deck_.references->unread();
  for (std::uint32_t u = 0; u < unread.size(); ++u) {
    found.assign(unread[u].parameter_values.begin(), unread[u].parameter_values.end());
    if (!unread[u].encrypted)
      gather_whole_numbers(deck_.files[unread[u].file].bytes.text().substr(unread[u].begin, unread[u].end - unread[u].begin), found);
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    for (const std::int64_t number : found) numbers_->emplace_back(number, u);
  }
  std::sort(numbers_->begin(), numbers_->end());
}

std::vector<std::uint32_t> UnreadNumbers::texts_with(Referred referred, std::int64_t id) const {
  // A transformed include's text gives ids less its offset. Every offset is tried: which one holds for a text isn't known here.
  std::set<std::int64_t> written{id};
  for (const IdOffsets& offsets : deck_.id_offsets)
    written.insert(id - (referred == Referred::node ? offsets.node : referred == Referred::part ? offsets.part : offsets.element));
  std::vector<std::uint32_t> texts;
  for (const std::int64_t number : written)
    for (auto at = std::lower_bound(numbers_->begin(), numbers_->end(), std::pair(number, std::uint32_t{0}));
         at != numbers_->end() && at->first == number; ++at)
      texts.push_back(at->second);
  std::sort(texts.begin(), texts.end());
  return texts;
}

const UnreadText* UnreadNumbers::holding_all(Referred referred, std::span<const std::int64_t> ids) {
  if (deck_.references->unread().empty()) return nullptr;
  gather();
  std::vector<std::uint32_t> all = texts_with(referred, ids.front());
  for (const std::int64_t id : ids.subspan(1)) {
    if (all.empty()) break;
    const std::vector<std::uint32_t> others = texts_with(referred, id);
    std::erase_if(all, [&](std::uint32_t text) { return !std::binary_search(others.begin(), others.end(), text); });
  }
  return all.empty() ? nullptr : &deck_.references->unread()[all.front()];
}

}  // namespace prismesh::mesh::deck

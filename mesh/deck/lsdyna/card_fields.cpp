#include "mesh/deck/lsdyna/card_fields.h"

#include <algorithm>

#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::lsdyna {
namespace {

constexpr std::array<int, 8> kTenColumns = {10, 10, 10, 10, 10, 10, 10, 10};

}  // namespace

std::string expand_tabs(std::string_view line) {
  std::string out;
  for (const char c : line) {
    if (c != '\t')
      out += c;
    else
      out.append(8 - out.size() % 8, ' ');
  }
  return out;
}

void CardFields::cut(std::string_view line, std::span<const int> widths, Columns columns) {
  count_ = 0;
  if (line.find(',') != std::string_view::npos) {
    while (count_ < kMaxFields) {
      const std::size_t comma = line.find(',');
      fields_[count_++] = trim(line.substr(0, comma));
      if (comma == std::string_view::npos) return;
      line.remove_prefix(comma + 1);
    }
    return;
  }
  if (line.find('\t') != std::string_view::npos) {
    expanded_ = expand_tabs(line);
    line = expanded_;
  }
  for (const int standard : widths) {
    if (line.empty() || count_ == kMaxFields) return;
    const auto width = std::min(static_cast<std::size_t>(field_width(standard, columns)), line.size());
    fields_[count_++] = trim(line.substr(0, width));
    line.remove_prefix(width);
  }
}

void CardFields::cut(std::string_view line, Columns columns) { cut(line, kTenColumns, columns); }

}  // namespace prismesh::mesh::deck::lsdyna

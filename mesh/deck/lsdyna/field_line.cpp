#include "mesh/deck/lsdyna/field_line.h"

#include <algorithm>

#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::lsdyna {
namespace {

/// The number in a field's columns: aligned left if the old number was, else right.
std::string padded(std::string_view number, std::string_view old, std::size_t width) {
  if (number.size() >= width) return std::string(number);
  const std::size_t first = old.find_first_not_of(' ');
  const bool leans_left =
      first != std::string_view::npos && first <= 1 && old.size() == width && old.back() == ' ' && first + number.size() < width;
  std::string out(width, ' ');
  std::copy(number.begin(), number.end(), out.begin() + static_cast<std::ptrdiff_t>(leans_left ? first : width - number.size()));
  return out;
}

}  // namespace

FieldLine::FieldLine(std::string_view line, std::span<const int> widths, Columns columns)
    : commas_(line.find(',') != std::string_view::npos) {
  for (const int standard : widths) widths_.push_back(static_cast<std::size_t>(field_width(standard, columns)));
  if (!commas_) {
    line_ = line.find('\t') == std::string_view::npos ? std::string(line) : expand_tabs(line);
    return;
  }
  for (std::size_t begin = 0;;) {
    const std::size_t comma = line.find(',', begin);
    fields_.emplace_back(line.substr(begin, comma - begin));
    if (comma == std::string_view::npos) break;
    begin = comma + 1;
  }
}

std::size_t FieldLine::begin_of(std::size_t field) const {
  std::size_t begin = 0;
  for (std::size_t f = 0; f < std::min(field, widths_.size()); ++f) begin += widths_[f];
  return begin;
}

std::size_t FieldLine::width(std::size_t field) const { return field < widths_.size() ? widths_[field] : 0; }

std::string_view FieldLine::text(std::size_t field) const {
  if (commas_) return field < fields_.size() ? trim(fields_[field]) : std::string_view();
  const std::size_t begin = begin_of(field);
  return begin < line_.size() ? trim(std::string_view(line_).substr(begin, width(field))) : std::string_view();
}

bool FieldLine::is_blank_or_zero(std::size_t field) const {
  double value = 1;
  return text(field).empty() || (parse_real(text(field), value) && value == 0);
}

void FieldLine::set(std::size_t field, std::string_view number) {
  if (commas_) {
    if (fields_.size() <= field) fields_.resize(field + 1);
    std::string& old = fields_[field];
    const std::string_view inner = trim(old);
    const std::size_t before = inner.empty() ? 0 : static_cast<std::size_t>(inner.data() - old.data());
    old.replace(before, inner.size(), number);
    return;
  }
  const std::size_t begin = begin_of(field);
  // On a short line the missing fields are zero; text behind the number stays where it is.
  if (line_.size() < begin + width(field)) line_.resize(begin + width(field), ' ');
  const std::string old = line_.substr(begin, width(field));
  line_.replace(begin, width(field), padded(number, old, width(field)));
}

std::string FieldLine::str() const {
  if (!commas_) return line_;
  std::string out;
  for (std::size_t f = 0; f < fields_.size(); ++f) out += (f > 0 ? "," : "") + fields_[f];
  return out;
}

std::size_t end_of_line(std::string_view text, std::size_t offset) {
  const std::size_t end = std::min(text.find('\n', offset), text.size());
  return end > offset && text[end - 1] == '\r' ? end - 1 : end;
}

}  // namespace prismesh::mesh::deck::lsdyna

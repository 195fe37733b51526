#include "mesh/deck/lsdyna/writer.h"

#include <algorithm>
#include <cmath>

#include "mesh/deck/lsdyna/card.h"
#include "mesh/deck/lsdyna/format_number.h"
#include "mesh/deck/lsdyna/number.h"

namespace prismesh::mesh::deck::lsdyna {
namespace {

std::string number_for(double value, std::size_t width, RewrittenCard& card) {
  std::string text = format_coordinate(value, width);
  double back = 0;
  if (!parse_real(text, back) || back != value) {
    ++card.rounded;
    card.largest_error = std::max(card.largest_error, std::abs(back - value));
  }
  return text;
}

/// In the field's place: leaning left if the old number did, else right.
std::string padded(const std::string& number, std::string_view old, std::size_t width) {
  if (number.size() >= width) return number;
  const std::size_t first = old.find_first_not_of(' ');
  const bool leans_left =
      first != std::string_view::npos && first <= 1 && old.size() == width && old.back() == ' ' && first + number.size() < width;
  std::string out(width, ' ');
  std::copy(number.begin(), number.end(), out.begin() + static_cast<std::ptrdiff_t>(leans_left ? first : width - number.size()));
  return out;
}

void rewrite_columns(std::string_view line, Columns columns, const Vec3& from, const Vec3& to, RewrittenCard& card) {
  card.text = line.find('\t') == std::string_view::npos ? std::string(line) : expand_tabs(line);
  const auto id_width = static_cast<std::size_t>(field_width(8, columns));
  const auto width = static_cast<std::size_t>(field_width(16, columns));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    if (from[a] == to[a]) continue;
    const std::size_t begin = id_width + axis * width;
    if (card.text.size() < begin + width) {
      // A short line lacks fields that are zero; one that follows the number stays where it is.
      card.text.resize(begin + width, ' ');
    }
    const std::string old = card.text.substr(begin, width);
    card.by_parameter |= old.find('&') != std::string::npos;
    card.text.replace(begin, width, padded(number_for(to[a], width, card), old, width));
  }
}

void rewrite_commas(std::string_view line, Columns columns, const Vec3& from, const Vec3& to, RewrittenCard& card) {
  const auto width = static_cast<std::size_t>(field_width(16, columns));
  std::vector<std::string> fields;
  for (std::size_t begin = 0;;) {
    const std::size_t comma = line.find(',', begin);
    fields.emplace_back(line.substr(begin, comma - begin));
    if (comma == std::string_view::npos) break;
    begin = comma + 1;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    if (from[a] == to[a]) continue;
    if (fields.size() < axis + 2) fields.resize(axis + 2);
    std::string& field = fields[axis + 1];
    card.by_parameter |= field.find('&') != std::string::npos;
    const std::string_view old = trim(field);
    const auto before = old.empty() ? std::size_t{0} : static_cast<std::size_t>(old.data() - field.data());
    field.replace(before, old.size(), number_for(to[a], std::max(width, old.size()), card));
  }
  for (std::size_t f = 0; f < fields.size(); ++f) card.text += (f > 0 ? "," : "") + fields[f];
}

}  // namespace

RewrittenCard rewrite_node_card(std::string_view line, Columns columns, const Vec3& from, const Vec3& to) {
  RewrittenCard card;
  if (line.find(',') != std::string_view::npos)
    rewrite_commas(line, columns, from, to, card);
  else
    rewrite_columns(line, columns, from, to, card);
  return card;
}

}  // namespace prismesh::mesh::deck::lsdyna

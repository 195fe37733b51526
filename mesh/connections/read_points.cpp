#include "mesh/connections/read_points.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "base/letter_case.h"

namespace prismesh::mesh::connections {

namespace {

constexpr std::string_view kBlanks = " \t\r";

std::string_view without_blanks(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  text = text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
  return text;
}

std::vector<std::string_view> fields_of(std::string_view line, char separator) {
  std::vector<std::string_view> fields;
  while (true) {
    const std::size_t end = line.find(separator);
    fields.push_back(without_blanks(line.substr(0, end)));
    if (end == std::string_view::npos) return fields;
    line.remove_prefix(end + 1);
  }
}

std::optional<double> number_in(std::string_view field) {
  if (field.starts_with('+')) field.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (field.empty() || error != std::errc() || end != field.data() + field.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

char separator_of(std::string_view line) {
  for (const char each : {';', ',', '\t'})
    if (line.find(each) != std::string_view::npos) return each;
  return ',';
}

std::string shortened(std::string_view field) { return "\"" + std::string(field.substr(0, 40)) + (field.size() > 40 ? "...\"" : "\""); }

/// Which columns are x, y and z, by a line of names; nullopt: it has no names.
std::optional<std::array<std::size_t, 3>> columns_named(const std::vector<std::string_view>& fields) {
  std::array<std::size_t, 3> columns{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::size_t at = 0;
    while (at < fields.size() && upper(fields[at]) != std::string(1, "XYZ"[axis])) ++at;
    if (at == fields.size()) return std::nullopt;
    columns[axis] = at;
  }
  return columns;
}

}  // namespace

Result<std::vector<Vec3>> read_points(std::string_view text, const std::string& file) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  std::vector<Vec3> points;
  std::array<std::size_t, 3> columns{0, 1, 2};
  bool is_first = true;
  for (long number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = without_blanks(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.empty() || line.front() == '#') continue;
    const std::vector<std::string_view> fields = fields_of(line, separator_of(line));
    if (std::exchange(is_first, false) && !number_in(fields.front())) {
      const auto named = columns_named(fields);
      if (!named) return fail(file, number, "the first line must name the columns x, y and z, or hold numbers");
      columns = *named;
      continue;
    }
    Vec3 point;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::string name(1, "xyz"[axis]);
      if (columns[axis] >= fields.size()) return fail(file, number, "the column " + name + " is missing here");
      const std::optional<double> value = number_in(fields[columns[axis]]);
      if (!value) return fail(file, number, name + " must be a number, not " + shortened(fields[columns[axis]]));
      point[static_cast<Eigen::Index>(axis)] = *value;
    }
    if (points.size() == kMaxPointsOfTable) return fail(file, number, "the table has more than a million points");
    points.push_back(point);
  }
  if (points.empty()) return fail(file, "the table has no point");
  return points;
}

}  // namespace prismesh::mesh::connections

#include "mesh/deck/abaqus/card_fields.h"

#include <algorithm>

#include "mesh/deck/abaqus/keyword.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::abaqus {

std::size_t end_of_line(std::string_view text, std::size_t offset) {
  const std::size_t end = std::min(text.find('\n', offset), text.size());
  return end > offset && text[end - 1] == '\r' ? end - 1 : end;
}

std::vector<FieldRange> places_of_line(std::string_view line, std::size_t at) {
  std::vector<FieldRange> out;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t comma = std::min(line.find(',', begin), line.size());
    if (comma == line.size() && trim(line.substr(begin)).empty()) break;
    out.push_back({at + begin, comma - begin});
    begin = comma + 1;
  }
  return out;
}

bool starts_with_blanks(std::string_view field) { return field.size() > 1 && field[0] == ' ' && field[1] == ' '; }

std::string in_place_of(std::string_view old, const std::string& text, bool column) {
  const std::string_view shown = trim(old);
  if (shown.empty()) return (old.empty() ? "" : " ") + text;
  const auto before = static_cast<std::size_t>(shown.data() - old.data());
  const std::size_t room = before + shown.size();
  std::string out(old.substr(0, before));
  if (column && before > 0) out.assign(room > text.size() ? room - text.size() : 1, ' ');
  return out + text + std::string(old.substr(room));
}

std::vector<FieldRange> cut_card(std::string_view text, std::size_t offset, std::size_t wanted, std::size_t& end) {
  std::vector<FieldRange> out;
  DataLines lines(text, offset, text.size());
  DataLine line;
  while (out.size() < wanted && lines.next(line)) {
    for (const FieldRange& place : places_of_line(line.text, line.offset))
      if (out.size() < wanted) out.push_back(place);
    end = end_of_line(text, line.offset);
    if (line.text.back() != ',' && out.size() % kIdsOnALine != 0) break;
  }
  return out;
}

}  // namespace prismesh::mesh::deck::abaqus

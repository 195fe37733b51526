#include "mesh/deck/nastran/case_set.h"

#include <algorithm>

#include "base/letter_case.h"
#include "mesh/deck/nastran/card.h"
#include "mesh/deck/nastran/card_edit.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::nastran {

Result<std::string> without_in_case_set(std::string text, std::span<const std::int64_t> leaving) {
  constexpr std::size_t kMaxLineLength = 72;
  constexpr std::string_view kBetween = ", \t\r\n";
  if (text.find('$') != std::string::npos) return fail("", "has comments between its ids");
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) return fail("", "isn't read");
  if (upper(text).find("EXCEPT") != std::string::npos) return fail("", "ends with what it leaves out");
  // Where the words stand; those of a range stay.
  std::size_t before = std::string::npos;  // the end of the word before
  bool behind_thru = false;
  for (std::size_t at = text.find_first_not_of(kBetween, equals + 1); at != std::string::npos;) {
    const std::size_t end = std::min(text.find_first_of(kBetween, at), text.size());
    const std::size_t next = text.find_first_not_of(kBetween, end);
    const std::string_view word = std::string_view(text).substr(at, end - at);
    std::int64_t id = 0;
    const bool before_thru = next != std::string::npos && begins_with(std::string_view(text).substr(next), "THRU");
    if (behind_thru || before_thru || !parse_integer(word, id) || std::find(leaving.begin(), leaving.end(), id) == leaving.end()) {
      behind_thru = begins_with(word, "THRU") || upper(word) == "BY";
      before = end;
      at = next;
    } else if (next == std::string::npos) {
      if (before == std::string::npos) return fail("", "would name nothing any more");
      text.erase(before, end - before);
      break;
    } else if (before != std::string::npos && text.find('\n', end) < next) {
      // The last of its line: the comma behind it and the line's end stay.
      text.erase(before, end - before);
      at = next - (end - before);
    } else {
      text.erase(at, next - at);
    }
  }
  for (std::size_t at = 0; at < text.size();) {
    const Line line = line_at(text, at);
    if (line.text.size() > kMaxLineLength) return fail("", "would have a line that is too long");
    at = line.next;
  }
  return text;
}

Result<std::vector<Replacement>> join_case_set(std::string_view text, const Referrer& set, std::span<const std::int64_t> ids) {
  if (upper(text.substr(set.offset, set.end - set.offset)).find("EXCEPT") != std::string::npos)
    return fail("", "ends with what it leaves out");
  std::size_t end = set.offset;
  for (std::size_t at = set.offset; at < set.end;) {
    const Line line = line_at(text.substr(0, set.end), at);
    const std::string_view data = line.text.substr(0, line.text.find('$'));
    if (!trim(data).empty()) end = line.offset + data.find_last_not_of(" \t") + 1;
    at = line.next;
  }
  const std::string line_end = line_end_at(text, set.offset);
  std::string added;
  std::size_t column = 72;
  for (const std::int64_t id : ids) {
    const std::string number = std::to_string(id);
    added += ',';
    if (column + number.size() + 1 > 70) {
      added += line_end + "  ";
      column = 2;
    }
    added += number;
    column += number.size() + 1;
  }
  return std::vector<Replacement>{{end, 0, std::move(added)}};
}

}  // namespace prismesh::mesh::deck::nastran

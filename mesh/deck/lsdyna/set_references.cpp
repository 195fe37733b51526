#include "mesh/deck/lsdyna/set_references.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>

#include "base/letter_case.h"
#include "mesh/deck/lsdyna/reference_tables.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::lsdyna {
namespace {

constexpr std::size_t kFieldsOnALine = 8;

/// What a set's keyword says of it.
struct SetKeyword {
  char letter = 'n';
  Referred member = Referred::node;      ///< of segments: their corners
  Referred set = Referred::segment_set;  ///< the set itself
  bool title = false;                    ///< a line before the header
  bool general = false;                  ///< each line begins with a word
  bool of_sets = false;                  ///< ADD, INTERSECT
  bool increment = false;                ///< first, last and step
  bool generate = false;                 ///< pairs of first and last
  bool column = false;                   ///< an id a line, with attributes

  bool segments() const { return letter == 'g'; }
};

SetKeyword set_keyword(char letter, std::string_view options) {
  SetKeyword keyword;
  keyword.letter = letter;
  if (!keyword.segments()) {
    referred_of(letter, keyword.member);
    referred_of(upper(letter), keyword.set);
  }
  keyword.title = has_word(options, "TITLE");
  keyword.general = has_word(options, "GENERAL");
  keyword.of_sets = has_word(options, "ADD") || has_word(options, "INTERSECT");
  keyword.increment = has_word(options, "INCREMENT");
  keyword.generate = has_word(options, "GENERATE");
  keyword.column = has_word(options, "COLUMN");
  return keyword;
}

bool are_known(std::string_view options) {
  constexpr std::string_view kKnown[] = {"LIST", "COLUMN",    "GENERATE", "INCREMENT", "GENERAL",
                                         "ADD",  "INTERSECT", "TITLE",    "COLLECT",   "SMOOTH"};
  for (std::string_view rest = options; !rest.empty();) {
    rest.remove_prefix(1);
    const std::string_view word = rest.substr(0, std::min(rest.find('_'), rest.size()));
    rest.remove_prefix(word.size());
    if (std::find(std::begin(kKnown), std::end(kKnown), word) == std::end(kKnown)) return false;
  }
  return true;
}

/// A set's line, cut into fields.
struct SetLine {
  Card card;
  std::size_t offset = 0;
};

/// A range that ends before it begins, or goes down, is taken as it was meant.
void add_range(Referred member, const SetLine& line, std::size_t field, std::int64_t step, ReferenceCollector& out) {
  std::int64_t first = out.number(line.card, field), last = out.number(line.card, field + 1);
  if (first == 0 && last == 0) return;
  if (last == 0) last = first;
  if (step < 0) step = -step;
  if (last < first) {
    const std::int64_t smallest = step > 1 ? last + (first - last) % step : last;
    last = std::exchange(first, smallest);
  }
  out.add({member, ReferenceRole::range, first, last, std::max<std::int64_t>(step, 1)}, line.offset);
}

void add_list(Referred member, const SetLine& line, ReferenceCollector& out) {
  for (std::size_t f = 0; f < kFieldsOnALine; ++f) out.add(member, ReferenceRole::list, out.number(line.card, f), line.offset);
}

void read_members(const SetKeyword& keyword, const SetLine& line, ReferenceCollector& out) {
  if (keyword.increment) return add_range(keyword.member, line, 0, out.number(line.card, 2), out);
  if (keyword.generate) {
    for (std::size_t f = 0; f < kFieldsOnALine; f += 2) add_range(keyword.member, line, f, 1, out);
    return;
  }
  if (keyword.column) return out.add(keyword.member, ReferenceRole::list, out.number(line.card, 0), line.offset);
  add_list(keyword.member, line, out);
}

/// A negative number means all sets from the one before up to it.
void read_sets_of_set(Referred set, const SetLine& line, ReferenceCollector& out) {
  for (std::size_t f = 0; f < kFieldsOnALine; ++f) {
    const std::int64_t id = out.number(line.card, f);
    const std::int64_t before = f > 0 ? out.number(line.card, f - 1) : 0;
    if (id < 0 && before > 0 && before < -id)
      out.add({set, ReferenceRole::range, before + 1, -id}, line.offset);
    else
      out.add(set, ReferenceRole::list, id, line.offset);
  }
}

/// Adds the ids of a general set's line, whose first field is a word. `takes_away`: the set is to be without them.
void add_named(Referred referred, ReferenceRole role, const SetLine& line, bool takes_away, ReferenceCollector& out) {
  for (std::size_t f = 1; f < kFieldsOnALine; ++f) {
    const std::int64_t id = std::abs(out.number(line.card, f));
    out.add({referred, role, id, id, 1, takes_away}, line.offset);
  }
}

void add_segment(const SetLine& line, std::size_t first, ReferenceRole role, bool takes_away, ReferenceCollector& out) {
  for (std::size_t f = first; f < first + 4; ++f) {
    const std::int64_t id = std::abs(out.number(line.card, f));
    out.add({Referred::node, role, id, id, 1, takes_away}, line.offset);
  }
}

/// "NODE, 1, 2, 3", "DPART, 4", "ALL"; those with a D take away what they name. False: the word isn't understood.
bool read_general(const SetKeyword& keyword, const SetLine& line, ReferenceCollector& out) {
  std::string word = upper(line.card.text(0));
  if (word.empty()) return true;
  if (word == "ALL") {
    if (!keyword.segments()) out.add({keyword.member, ReferenceRole::range, 1, kEveryId}, line.offset);
    return true;
  }
  const bool takes_away = word.front() == 'D';
  if (takes_away) word.erase(0, 1);
  const ReferenceRole role = takes_away ? ReferenceRole::single : ReferenceRole::list;
  const auto names = [&](Referred referred, ReferenceRole as) {
    add_named(referred, as, line, takes_away, out);
    return true;
  };
  if (word == "PART" || word == "PART_IO") return names(Referred::part, ReferenceRole::single);
  if (word == "BOX" || word.starts_with("BOX_") || word == "VOL" || word.starts_with("VOL_")) return true;
  if (keyword.segments()) {
    if (word == "SHELL") return names(Referred::shell, ReferenceRole::single);
    if (word != "SEG") return false;
    add_segment(line, 1, takes_away ? role : ReferenceRole::segment, takes_away, out);
    return true;
  }
  if (keyword.letter == 'n') return word == "NODE" && names(Referred::node, role);
  if (keyword.letter == 'p') return false;
  if (word == "ELEM" || word == "ELEMENT") return names(keyword.member, role);
  return word == "SET" && names(keyword.set, role);
}

bool read_line(const SetKeyword& keyword, const SetLine& line, ReferenceCollector& out) {
  if (keyword.general) return read_general(keyword, line, out);
  if (keyword.of_sets)
    read_sets_of_set(keyword.set, line, out);
  else if (keyword.segments())
    add_segment(line, 0, ReferenceRole::segment, false, out);
  else
    read_members(keyword, line, out);
  return true;
}

}  // namespace

bool read_set_references(BlockLines& lines, char letter, std::string_view options, ReferenceCollector& out) {
  const SetKeyword keyword = set_keyword(letter, options);
  Line line;
  std::string_view title;
  if (keyword.title) {
    if (!lines.next(line)) return true;
    title = trim(line.text);
  }
  if (!lines.next(line)) return true;
  SetLine fields;
  out.cut(line, fields.card);
  const std::int64_t id = out.number(fields.card, 0);
  out.begin_referrer({out.block().keyword_offset, id > 0 ? out.with_offset(keyword.set, id) : id, title, keyword.set});
  if (!are_known(options)) return false;
  while (lines.next(line)) {
    out.cut(line, fields.card);
    fields.offset = line.offset;
    if (!read_line(keyword, fields, out)) return false;
  }
  return true;
}

}  // namespace prismesh::mesh::deck::lsdyna

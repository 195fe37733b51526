#include "mesh/deck/lsdyna/set_writer.h"

#include <algorithm>
#include <set>

#include "base/letter_case.h"
#include "mesh/deck/lsdyna/field_line.h"
#include "mesh/deck/lsdyna/mesh_cards.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::lsdyna {
namespace {

constexpr std::array<int, 8> kSetWidths = {10, 10, 10, 10, 10, 10, 10, 10};

std::string_view eol_of(std::string_view text, std::size_t line) {
  const std::size_t newline = text.find('\n', line);
  const std::size_t known = newline != std::string_view::npos ? newline : text.rfind('\n');
  return known != std::string_view::npos && known > 0 && text[known - 1] == '\r' ? "\r\n" : "\n";
}

/// The data lines of a set, without title and header.
Result<std::vector<Line>> members_of(std::string_view text, const Referrer& set) {
  Lines lines(text, set.offset, std::min<std::size_t>(set.end, text.size()));
  Line line;
  std::vector<Line> members;
  int before = has_word(set.keyword, "TITLE") ? 3 : 2;  // the keyword's own line, a title, the header
  while (lines.next(line)) {
    if (line.text.substr(0, kEncryptedBegin.size()) == kEncryptedBegin) return fail("", "is encrypted in part");
    if (before-- > 0) continue;
    if (!trim(line.text).empty()) members.push_back(line);
  }
  return members;
}

/// Whether a line of a general set lists single nodes or elements; others name parts, sets or boxes.
bool lists_single_ones(std::string_view word) { return word == "NODE" || word == "ELEM" || word == "ELEMENT"; }

/// A list of ids. In a general set the first field of each line is a word.
class IdList {
 public:
  IdList(std::string_view text, const Referrer& set, std::vector<Line> lines)
      : text_(text), columns_(columns_of(set.style)), general_(has_word(set.keyword, "GENERAL")), lines_(std::move(lines)) {}

  /// Removes ids from their lines; those behind move up. False: one of them isn't there as a plain number.
  bool take_out(std::span<const std::int64_t> leaving, std::vector<Replacement>& out) {
    std::set<std::int64_t> wanted(leaving.begin(), leaving.end()), found;
    const std::size_t first = general_ ? 1 : 0;
    for (const Line& line : lines_) {
      FieldLine fields(line.text, kSetWidths, columns_);
      const std::string word = general_ ? upper(fields.text(0)) : std::string();
      if (general_ && !lists_single_ones(word)) {
        if (!word.starts_with('D')) ++remaining_;  // DNODE, DPART, ... only remove ids
        continue;
      }
      std::vector<std::string> kept;
      bool touched = false;
      for (std::size_t f = first; f < 8; ++f) {
        std::int64_t id = 0;
        if (parse_integer(fields.text(f), id) && wanted.contains(id)) {
          found.insert(id);
          touched = true;
        } else if (!fields.is_blank_or_zero(f)) {
          kept.emplace_back(fields.text(f));
        }
      }
      remaining_ += kept.size();
      if (!touched) continue;
      if (kept.empty()) {
        const std::size_t newline = text_.find('\n', line.offset);
        out.push_back({line.offset, (newline == std::string_view::npos ? text_.size() : newline + 1) - line.offset, ""});
        continue;
      }
      out.push_back({line.offset, line.text.size(), rewritten(line, fields, first, kept)});
    }
    return found.size() == wanted.size();
  }

  std::size_t remaining() const { return remaining_; }

 private:
  std::string rewritten(const Line& line, const FieldLine& fields, std::size_t first, const std::vector<std::string>& kept) const {
    FieldLine out(line.text, kSetWidths, columns_);
    // Behind the last id stand zeros where the line had them, else nothing.
    bool zeros = false;
    for (std::size_t f = first; f < 8; ++f) zeros |= fields.text(f) == "0";
    for (std::size_t f = first; f < 8; ++f) {
      const std::size_t at = f - first;
      if (at < kept.size())
        out.set(f, kept[at]);
      else if (!fields.text(f).empty())
        out.set(f, zeros ? "0" : "");
    }
    std::string text = out.str();
    const std::size_t last = text.find_last_not_of(zeros ? " " : " ,");
    if (line.text.find_last_not_of(' ') + 1 == line.text.size()) text.resize(last + 1);
    return text;
  }

  std::string_view text_;
  Columns columns_;
  bool general_;
  std::vector<Line> lines_;
  std::size_t remaining_ = 0;
};

/// How new lines of a set look.
struct LineFormat {
  std::size_t fields = 8;
  std::string_view word;  ///< in the first field; empty: no word
  bool zeros = false;     ///< unused fields hold zeros
  bool free_format = false;
  Columns columns = Columns::standard;
  std::string_view eol;
};

std::string new_lines(std::span<const std::string> values, const LineFormat& format) {
  std::string out;
  const std::size_t first = format.word.empty() ? 0 : 1;
  for (std::size_t at = 0; at < values.size(); at += format.fields - first) {
    FieldLine line(format.free_format ? "," : "", kSetWidths, format.columns);
    if (!format.word.empty()) line.set(0, format.word);
    for (std::size_t f = first; f < format.fields; ++f) {
      if (at + f - first < values.size())
        line.set(f, values[at + f - first]);
      else if (format.zeros)
        line.set(f, "0");
    }
    out += line.str() + std::string(format.eol);
  }
  return out;
}

std::vector<std::string> texts_of(std::span<const std::int64_t> ids) {
  std::vector<std::string> texts;
  for (const std::int64_t id : ids) texts.push_back(std::to_string(id));
  return texts;
}

/// Ids that count up by one, as first and last.
std::vector<std::string> ranges_of(std::span<const std::int64_t> ids, bool with_step) {
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < ids.size();) {
    std::size_t end = i + 1;
    while (end < ids.size() && ids[end] == ids[end - 1] + 1) ++end;
    texts.push_back(std::to_string(ids[i]));
    texts.push_back(std::to_string(ids[end - 1]));
    if (with_step) texts.push_back("1");
    i = end;
  }
  return texts;
}

/// A keyword with Inheritance::follows, and the field that names the single node or shell.
struct Followed {
  std::string_view keyword;
  std::size_t field;
};
constexpr Followed kFollowedNodes[] = {
    {"BOUNDARY_SPC_NODE", 0},        {"BOUNDARY_TEMPERATURE_NODE", 0}, {"CONSTRAINED_EXTRA_NODES_NODE", 1},
    {"INITIAL_TEMPERATURE_NODE", 0}, {"INITIAL_VELOCITY_NODE", 0},
};
constexpr Followed kFollowedShells[] = {{"LOAD_SHELL_ELEMENT", 0}};

bool is_initial_shell(std::string_view keyword) { return keyword == "INITIAL_STRESS_SHELL" || keyword == "INITIAL_STRAIN_SHELL"; }

/// The minimum number of lines of values of an initial stress or strain: one for each layer at each integration point in the plane.
std::int64_t min_lines(const FieldLine& shell) {
  std::int64_t lines = 1;
  for (const std::size_t field : {std::size_t{1}, std::size_t{2}}) {
    std::int64_t count = 0;
    if (parse_integer(shell.text(field), count) && count > 0 && count < 1000) lines *= count;
  }
  return lines;
}

std::optional<std::size_t> followed_field(std::string_view keyword, Referred referred) {
  if (is_initial_shell(keyword)) return 0;
  const std::span<const Followed> table = referred == Referred::node ? std::span<const Followed>(kFollowedNodes) : kFollowedShells;
  for (const Followed& entry : table)
    if (entry.keyword == keyword) return entry.field;
  return std::nullopt;
}

/// The field of a segment's first corner; nullopt: the line is no segment that can be replaced.
std::optional<std::size_t> first_corner(const Referrer& set, const FieldLine& line) {
  if (!set.keyword.starts_with("SET_SEGMENT")) return std::nullopt;
  if (!has_word(set.keyword, "GENERAL")) return 0;
  if (upper(line.text(0)) != "SEG") return std::nullopt;
  return 1;
}

std::string_view line_at(std::string_view text, std::size_t offset) { return text.substr(offset, end_of_line(text, offset) - offset); }

/// How a set's lines say what it holds.
enum class ListLayout : std::uint8_t {
  plain,      ///< ids, eight a line
  column,     ///< an id a line, with attributes
  generate,   ///< pairs of first and last, four a line
  increment,  ///< first, last and step
  general,    ///< a word, then ids
};

ListLayout layout_of(std::string_view keyword) {
  if (has_word(keyword, "GENERAL")) return ListLayout::general;
  if (has_word(keyword, "COLUMN")) return ListLayout::column;
  if (has_word(keyword, "INCREMENT")) return ListLayout::increment;
  return has_word(keyword, "GENERATE") ? ListLayout::generate : ListLayout::plain;
}

/// A set whose lines change.
struct ListedSet {
  std::string_view text;  ///< of its file
  const Referrer& set;
  ListLayout layout = ListLayout::plain;
  Columns columns = Columns::standard;
  std::vector<Line> members;  ///< its data lines; not empty
};

Result<ListedSet> find_list(std::string_view text, const Referrer& set) {
  if (!set.keyword.starts_with("SET_")) return fail("", "lists what it is about in a way that this version can't change");
  if (has_word(set.keyword, "ADD") || has_word(set.keyword, "INTERSECT")) return fail("", "is made of other sets");
  Result<std::vector<Line>> members = members_of(text, set);
  if (!members) return fail(members.error());
  if (members->empty()) return fail("", "has no line after which another could go");
  return ListedSet{text, set, layout_of(set.keyword), columns_of(set.style), std::move(*members)};
}

Result<void> take_out(const ListedSet& of, std::span<const std::int64_t> leaving, bool others_join, std::vector<Replacement>& out) {
  if (of.layout == ListLayout::column) return fail("", "lists its entries with attributes, from which none can be taken out");
  IdList list(of.text, of.set, of.members);
  if (!list.take_out(leaving, out)) return fail("", "names what would go by a parameter, or otherwise than as a plain number");
  if (list.remaining() == 0 && !others_join) return fail("", "would be left empty");
  return {};
}

/// Lines for new entries, each with the attributes that all the others have.
Result<std::string> column_lines(const ListedSet& of, std::span<const std::int64_t> joining, std::string_view eol) {
  const std::string_view last = of.members.back().text;
  const FieldLine fields(last, kSetWidths, of.columns);
  for (std::size_t f = 1; f < 5; ++f)
    for (const Line& line : of.members)
      if (FieldLine(line.text, kSetWidths, of.columns).text(f) != fields.text(f))
        return fail("", "gives its entries different attributes, and it can't be told which a new one has");
  std::string out;
  for (const std::int64_t id : joining) {
    FieldLine line(last, kSetWidths, of.columns);
    line.set(0, std::to_string(id));
    out += line.str() + std::string(eol);
  }
  return out;
}

/// Puts values, `whole` of them together, into the free fields at a line's end. Returns how many fit.
std::size_t fill_up(FieldLine& fields, std::span<const std::string> values, std::size_t whole) {
  std::size_t used = 8, filled = 0;
  while (used > 0 && fields.is_blank_or_zero(used - 1)) --used;
  used += used % whole;
  while (used + whole <= 8 && filled + whole <= values.size())
    for (std::size_t i = 0; i < whole; ++i) fields.set(used++, values[filled++]);
  return filled;
}

bool has_zeros(const FieldLine& fields) {
  for (std::size_t f = 0; f < 8; ++f)
    if (fields.text(f) == "0") return true;
  return false;
}

std::string_view general_word(std::string_view keyword) {
  if (keyword.starts_with("SET_NODE")) return "NODE";
  return keyword.starts_with("SET_PART") ? "PART" : "ELEM";
}

/// What joins a list: more in its last line, and lines behind it.
struct Joining {
  std::string last_line;
  std::string new_lines;
};

/// `last_line`: the text of the set's last line; empty where it is removed, so that nothing can be put into it.
Result<Joining> join_lines(const ListedSet& of, std::string last_line, std::span<const std::int64_t> ids, std::string_view eol) {
  const bool removed = last_line.empty();
  FieldLine fields(removed ? of.members.back().text : last_line, kSetWidths, of.columns);
  LineFormat format{8, {}, false, fields.free_format(), of.columns, eol};
  switch (of.layout) {
    case ListLayout::general: format.word = general_word(of.set.keyword); return Joining{last_line, new_lines(texts_of(ids), format)};
    case ListLayout::column: {
      Result<std::string> lines = column_lines(of, ids, eol);
      if (!lines) return fail(lines.error());
      return Joining{last_line, std::move(*lines)};
    }
    case ListLayout::increment: format.fields = 3; return Joining{last_line, new_lines(ranges_of(ids, true), format)};
    case ListLayout::generate:
    case ListLayout::plain: break;
  }
  format.zeros = has_zeros(fields);
  const bool generate = of.layout == ListLayout::generate;
  const std::vector<std::string> values = generate ? ranges_of(ids, false) : texts_of(ids);
  const std::size_t filled = removed ? 0 : fill_up(fields, values, generate ? 2 : 1);
  if (filled > 0) last_line = fields.str();
  return Joining{std::move(last_line), new_lines(std::span(values).subspan(filled), format)};
}

Result<void> put_in(const ListedSet& of, std::span<const std::int64_t> joining, std::vector<Replacement>& out) {
  const Line& last = of.members.back();
  const auto rewritten = std::find_if(out.begin(), out.end(), [&](const Replacement& r) { return r.offset == last.offset; });
  const std::string before = rewritten != out.end() ? rewritten->text : std::string(last.text);
  const std::string_view eol = eol_of(of.text, last.offset);
  Result<Joining> joined = join_lines(of, before, joining, eol);
  if (!joined) return fail(joined.error());
  if (rewritten != out.end())
    rewritten->text = std::move(joined->last_line);
  else if (joined->last_line != last.text)
    out.push_back({last.offset, last.text.size(), std::move(joined->last_line)});
  std::string& lines = joined->new_lines;
  if (lines.empty()) return {};
  const std::size_t newline = of.text.find('\n', last.offset);
  if (newline == std::string_view::npos) {
    lines.resize(lines.size() - eol.size());
    out.push_back({of.text.size(), 0, std::string(eol) + lines});
  } else {
    out.push_back({newline + 1, 0, std::move(lines)});
  }
  return {};
}

}  // namespace

Result<std::vector<Replacement>> change_set(std::string_view text, const Referrer& set, std::span<const std::int64_t> joining,
                                            std::span<const std::int64_t> leaving) {
  const Result<ListedSet> list = find_list(text, set);
  if (!list) return fail(list.error());
  for (const std::int64_t id : joining)
    if (std::to_string(id).size() > static_cast<std::size_t>(field_width(10, list->columns)))
      return fail("", "has fields too narrow for the new ids");
  std::vector<Replacement> out;
  if (!leaving.empty())
    if (Result<void> done = take_out(*list, leaving, !joining.empty(), out); !done) return fail(done.error());
  if (!joining.empty())
    if (Result<void> done = put_in(*list, joining, out); !done) return fail(done.error());
  return out;
}

std::optional<std::array<std::int64_t, 4>> read_segment(std::string_view text, const Referrer& set, std::size_t card) {
  const FieldLine line(line_at(text, card), kSetWidths, columns_of(set.style));
  const std::optional<std::size_t> first = first_corner(set, line);
  if (!first) return std::nullopt;
  std::array<std::int64_t, 4> corners{};
  for (std::size_t c = 0; c < 4; ++c)
    if (!parse_integer(line.text(*first + c), corners[c])) return std::nullopt;
  if (corners[3] == 0) corners[3] = corners[2];
  return corners;
}

Result<std::vector<Replacement>> replace_segment(std::string_view text, const Referrer& set, std::size_t card,
                                                 std::span<const std::array<std::int64_t, 4>> with) {
  const std::string_view before = line_at(text, card);
  const FieldLine old(before, kSetWidths, columns_of(set.style));
  const std::optional<std::size_t> first = first_corner(set, old);
  if (!first) return fail("", "can't be replaced");
  if (with.empty()) {
    const std::size_t newline = text.find('\n', card);
    return std::vector<Replacement>{{card, (newline == std::string_view::npos ? text.size() : newline + 1) - card, ""}};
  }
  std::string lines;
  for (std::size_t i = 0; i < with.size(); ++i) {
    FieldLine line = old;
    for (std::size_t c = 0; c < 4; ++c) {
      std::int64_t node = 0;
      if (parse_integer(line.text(*first + c), node) && node == with[i][c]) continue;
      const std::string number = std::to_string(with[i][c]);
      if (!line.free_format() && number.size() > line.width(*first + c)) return fail("", "has fields too narrow for the new ids");
      line.set(*first + c, number);
    }
    lines += (i > 0 ? std::string(eol_of(text, card)) : std::string()) + line.str();
  }
  return std::vector<Replacement>{{card, before.size(), lines}};
}

Inheritance inheritance_of(const Referrer& card, Referred referred) {
  const std::string_view keyword = card.keyword;
  if (followed_field(keyword, referred)) return Inheritance::follows;
  if (keyword.starts_with("DATABASE_") || keyword.starts_with("SENSOR_")) return Inheritance::stays;
  // A card that constrains, drives or heats a node, gives its initial state or removes it from a set, or that loads or stresses a shell,
  // must not apply to only a part of where it did.
  if (referred != Referred::node) return Inheritance::forbids;
  for (const std::string_view start : {"BOUNDARY_", "INITIAL_", "LOAD_THERMAL_", "AIRBAG_", "SET_"})
    if (keyword.starts_with(start)) return Inheritance::forbids;
  // Joints, welds, coordinate systems, point forces.
  return Inheritance::stays;
}

Result<std::vector<Replacement>> copy_single(std::string_view text, const Referrer& card, const Reference& single,
                                             std::span<const std::int64_t> ids) {
  const std::optional<std::size_t> field = followed_field(card.keyword, is_element(single.referred) ? Referred::shell : Referred::node);
  if (!field) return fail("", "can't be written again for another");
  const Columns columns = columns_of(card.style);
  const std::string_view first = line_at(text, single.card);
  std::size_t end = single.card + first.size();
  if (is_initial_shell(card.keyword)) {
    // As in reading: the values have decimal points, the line of the next element has whole numbers only.
    Lines lines(text, single.card, std::min<std::size_t>(card.end, text.size()));
    Line line;
    lines.next(line);
    std::int64_t found = 0;
    for (; lines.next(line) && line.text.find('.') != std::string_view::npos; ++found) end = line.offset + line.text.size();
    if (found < min_lines(FieldLine(first, kSetWidths, columns)))
      return fail("", "has values without a point, which can't be told from the next shell's line");
  }
  FieldLine line(first, kSetWidths, columns);
  if (line.by_parameter(*field)) return fail("", "names it by the parameter " + std::string(line.text(*field)));
  const std::string_view rest = text.substr(single.card + first.size(), end - single.card - first.size());
  const std::string_view eol = eol_of(text, single.card);
  std::string copies;
  for (const std::int64_t id : ids) {
    const std::string number = std::to_string(id);
    if (!line.free_format() && number.size() > line.width(*field)) return fail("", "has fields too narrow for the new ids");
    line.set(*field, number);
    copies += line.str() + std::string(rest) + std::string(eol);
  }
  const std::size_t newline = text.find('\n', end);
  if (newline != std::string_view::npos) return std::vector<Replacement>{{newline + 1, 0, copies}};
  copies.resize(copies.size() - eol.size());
  return std::vector<Replacement>{{text.size(), 0, std::string(eol) + copies}};
}

}  // namespace prismesh::mesh::deck::lsdyna

#include "mesh/deck/nastran/card.h"

#include <algorithm>
#include <cstring>

#include "base/letter_case.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::nastran {
namespace {

/// A comma within these columns makes a line free-field; further right it is part of a field of columns.
constexpr std::size_t kCommaColumns = 16;
/// Longer lines are read up to here: ten free fields are shorter.
constexpr std::size_t kLineColumns = 400;
/// More continuations than any card has.
constexpr std::size_t kMaxLines = 1000000;

bool is_letter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); }

/// The name of a continuation, without the sign that makes it one.
std::string_view bare(std::string_view name) {
  name = trim(name);
  if (!name.empty() && (name[0] == '+' || name[0] == '*')) name.remove_prefix(1);
  return trim(name);
}

std::string_view without_first(std::string_view field) { return trim(field.substr(std::min<std::size_t>(1, field.size()))); }

/// One of them blank counts as the same.
bool same_name(std::string_view a, std::string_view b) {
  return a.empty() || b.empty() ||
         (a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](char x, char y) { return upper(x) == upper(y); }));
}

/// Whether a line that begins with the field `own` continues one whose last field is `next`. The first column of each (1 and 73) isn't part
/// of the name. Names that don't stand in their columns are compared without their signs.
bool continues(std::string_view next, std::string_view own) {
  return same_name(without_first(next), without_first(own)) || same_name(bare(next), bare(own));
}

std::string_view without_comment(std::string_view line) { return line.substr(0, line.find('$')); }

}  // namespace

bool has_point(std::string_view text) { return text.find('.') != std::string_view::npos; }

bool begins_with(std::string_view text, std::string_view start) {
  return text.size() >= start.size() && std::equal(start.begin(), start.end(), text.begin(), [](char s, char t) { return s == upper(t); });
}

Line line_at(std::string_view text, std::size_t at) {
  const void* found = std::memchr(text.data() + at, '\n', text.size() - at);
  const std::size_t end = found ? static_cast<std::size_t>(static_cast<const char*>(found) - text.data()) : text.size();
  Line line{text.substr(at, end - at), at, found ? end + 1 : end};
  if (!line.text.empty() && line.text.back() == '\r') line.text.remove_suffix(1);
  return line;
}

LineKind kind_of(std::string_view line) {
  if (line.empty() || line[0] == '$') return LineKind::comment;
  const char c = line[0];
  if (is_letter(c)) return LineKind::card;
  if (c == '+' || c == '*' || c == ',') return LineKind::continuation;
  if (c == '=') return LineKind::replication;
  if (c != ' ' && c != '\t') return LineKind::card;
  const std::size_t first = line.find_first_not_of(" \t\r");
  if (first == std::string_view::npos || line[first] == '$') return LineKind::comment;
  if (first < kNameColumns && is_letter(line[first]) && line.substr(0, first).find('\t') == std::string_view::npos) return LineKind::card;
  return LineKind::continuation;
}

Layout layout_of(std::string_view line) {
  const std::string_view head = line.substr(0, kCommaColumns);
  const std::size_t comma = head.find(',');
  const bool is_free = comma != std::string_view::npos && head.find('$') > comma;
  const std::string_view name = line.substr(0, std::min(kNameColumns, line.find_first_of(",\t")));
  const bool large = name.find('*') != std::string_view::npos;
  if (is_free) return large ? Layout::free_large : Layout::free_small;
  return large ? Layout::large : Layout::small;
}

std::string without_tabs(std::string_view line) {
  std::string out;
  for (const char c : line.substr(0, kLineColumns)) {
    if (c != '\t')
      out += c;
    else
      out.append(8 - out.size() % 8, ' ');
  }
  return out;
}

void CardLines::read(std::string_view text, std::size_t at) {
  lines.clear();
  cut_off = false;
  lines.push_back(line_at(text, at));
  end = at + lines[0].text.size();
  next = lines[0].next;
  for (std::size_t from = next; from < text.size();) {
    const Line line = line_at(text, from);
    const LineKind kind = kind_of(line.text);
    from = line.next;
    if (kind == LineKind::comment) continue;
    if (kind != LineKind::continuation) break;
    end = line.offset + line.text.size();
    next = line.next;
    if (lines.size() < kMaxLines)
      lines.push_back(line);
    else
      cut_off = true;
  }
}

std::size_t end_of_card(std::string_view text, std::size_t at) {
  const Line first = line_at(text, at);
  std::size_t end = at + first.text.size();
  for (std::size_t from = first.next; from < text.size();) {
    const Line line = line_at(text, from);
    const LineKind kind = kind_of(line.text);
    from = line.next;
    if (kind == LineKind::comment) continue;
    if (kind != LineKind::continuation) break;
    end = line.offset + line.text.size();
  }
  return end;
}

void Card::cut(const CardLines& lines) {
  fields_.clear();
  owned_.clear();
  misplaced_.reset();
  overlong_ = false;
  for (std::size_t i = 0; i < lines.lines.size(); ++i) cut_line(lines.lines[i], i == 0);
}

void Card::assign(std::string_view name, const std::vector<std::string>& fields, Layout layout) {
  fields_.clear();
  owned_.assign(fields.begin(), fields.end());
  for (const std::string& field : owned_) fields_.push_back(trim(field));
  set_name(name);
  layout_ = layout;
  misplaced_.reset();
  overlong_ = false;
}

void Card::set_name(std::string_view name) {
  name = trim(name.substr(0, name.find('*')));
  name_size_ = 0;
  for (std::size_t i = 0; i < kNameColumns && i < name.size(); ++i) name_[name_size_++] = upper(name[i]);
}

void Card::cut_line(const Line& line, bool first) {
  const Layout layout = layout_of(line.text);
  // A large-field entry has eight fields each two lines: where the second is left out, its fields are blank.
  if (!first && fields_.size() % 8 == 4 && is_large(last_layout_) && !is_large(layout)) fields_.resize(fields_.size() + 4);
  std::string_view own, next;
  if (is_free(layout))
    cut_commas(line.text, layout, own, next);
  else
    cut_columns(line.text, layout, own, next);
  if (first) {
    set_name(own);
    layout_ = layout;
  } else {
    if (!misplaced_ && !continues(next_field_, own)) misplaced_ = line.offset;
  }
  next_field_ = next;
  last_layout_ = layout;
}

void Card::cut_columns(std::string_view line, Layout layout, std::string_view& own, std::string_view& next) {
  line = line.substr(0, kLineColumns);
  if (line.find('\t') != std::string_view::npos) line = owned_.emplace_back(without_tabs(line));
  line = without_comment(line.substr(0, kDataColumns + kNameColumns));
  own = line.substr(0, kNameColumns);
  const std::size_t width = width_of(layout);
  for (std::size_t begin = kNameColumns; begin < kDataColumns; begin += width)
    fields_.push_back(begin < line.size() ? trim(line.substr(begin, width)) : std::string_view());
  next = line.size() > kDataColumns ? line.substr(kDataColumns) : std::string_view();
}

void Card::cut_commas(std::string_view line, Layout layout, std::string_view& own, std::string_view& next) {
  line = without_comment(line.substr(0, kLineColumns));
  const std::size_t max_fields = fields_on(layout);
  std::size_t count = 0;
  const auto add = [&](std::string_view field) {
    if (count < max_fields)
      fields_.push_back(field);
    else if (count == max_fields)
      next = field;
    else
      overlong_ |= !field.empty();
    ++count;
  };
  std::size_t comma = line.find(',');
  own = line.substr(0, comma);
  while (comma != std::string_view::npos) {
    line.remove_prefix(comma + 1);
    comma = line.find(',');
    std::string_view field = trim(line.substr(0, comma));
    // Blanks separate fields as well.
    for (std::size_t gap; (gap = field.find_first_of(" \t")) != std::string_view::npos; field = trim(field.substr(gap)))
      add(field.substr(0, gap));
    add(field);
  }
  for (; count < max_fields; ++count) fields_.emplace_back();
}

std::optional<std::int64_t> Card::integer(std::size_t field) const {
  std::int64_t value = 0;
  if (!parse_integer(text(field), value)) return std::nullopt;
  return value;
}

std::optional<double> Card::real(std::size_t field) const {
  double value = 0;
  if (!parse_real(text(field), value)) return std::nullopt;
  return value;
}

}  // namespace prismesh::mesh::deck::nastran

#include "mesh/deck/nastran/card_edit.h"

#include <algorithm>
#include <utility>

#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::nastran {
namespace {

/// A value in the field's columns: aligned left if the old text was, else right.
std::string padded(const std::string& value, std::string_view old, std::size_t width, bool left_if_blank) {
  if (value.size() >= width) return value;
  const std::size_t first = old.find_first_not_of(' ');
  const bool blank = first == std::string_view::npos;
  const bool left = blank ? left_if_blank : first == 0 && (old.size() < width || old.back() == ' ');
  std::string out(width, ' ');
  std::copy(value.begin(), value.end(), out.begin() + static_cast<std::ptrdiff_t>(left ? 0 : width - value.size()));
  return out;
}

/// The columns of a small or large field.
std::string_view field_of(std::string_view line, std::size_t slot, Layout layout) {
  const std::size_t width = width_of(layout), begin = kNameColumns + slot * width;
  return begin < line.size() ? line.substr(begin, width) : std::string_view();
}

/// Whether the line's numbers are aligned left, judged by the first that is narrower than its field.
bool leans_left(std::string_view line, Layout layout) {
  for (std::size_t slot = 0; slot < fields_on(layout); ++slot) {
    const std::string_view field = field_of(line, slot, layout);
    const std::size_t first = field.find_first_not_of(" \t\r");
    if (first == std::string_view::npos || trim(field).size() == width_of(layout)) continue;
    return first == 0;
  }
  return false;
}

std::vector<std::string> tokens_of(std::string_view data) {
  std::vector<std::string> tokens;
  for (std::size_t begin = 0;;) {
    const std::size_t comma = data.find(',', begin);
    const std::string_view token = data.substr(begin, comma - begin);
    const std::string_view inner = trim(token);
    if (!tokens.empty() && inner.find_first_of(" \t") != std::string_view::npos) {
      // Blanks separate fields as well; the new text has commas instead.
      for (std::string_view rest = inner; !rest.empty();) {
        const std::size_t gap = std::min(rest.find_first_of(" \t"), rest.size());
        tokens.emplace_back(rest.substr(0, gap));
        rest = trim(rest.substr(gap));
      }
    } else {
      tokens.emplace_back(token);
    }
    if (comma == std::string_view::npos) return tokens;
    begin = comma + 1;
  }
}

}  // namespace

std::string line_end_at(std::string_view text, std::size_t offset) {
  std::size_t end = text.find('\n', offset);
  if (end == std::string_view::npos && offset > 0) end = text.rfind('\n', offset - 1);
  return end != std::string_view::npos && end > 0 && text[end - 1] == '\r' ? "\r\n" : "\n";
}

CardEdit::CardEdit(std::string_view text, std::size_t offset) : line_end_(line_end_at(text, offset)) {
  const std::size_t end = end_of_card(text, offset);
  std::size_t fields = 0;
  Layout last = Layout::small;
  for (std::size_t at = offset; at < end;) {
    const Line line = line_at(text.substr(0, end), at);
    Row row;
    row.text = line.text;
    row.end = text.substr(at + line.text.size(), line.next - at - line.text.size());
    row.comment = !rows_.empty() && kind_of(line.text) == LineKind::comment;
    row.layout = layout_of(line.text);
    if (!row.comment) {
      // As Card counts them: a large-field entry has eight fields on each two lines.
      if (fields % 8 == 4 && is_large(last) && !is_large(row.layout)) fields += 4;
      row.first_field = fields;
      fields += fields_on(row.layout);
      last = row.layout;
    }
    rows_.push_back(std::move(row));
    at = line.next;
  }
}

const CardEdit::Row* CardEdit::row_of(std::size_t field) const {
  for (const Row& row : rows_)
    if (!row.comment && field >= row.first_field && field < row.first_field + fields_on(row.layout)) return &row;
  return nullptr;
}

std::size_t CardEdit::width(std::size_t field) const {
  const Row* row = row_of(field);
  if (!row) return width_of(rows_.back().layout);
  if (!is_free(row->layout)) return width_of(row->layout);
  const std::vector<std::string> tokens = tokens_of(std::string_view(row->text).substr(0, row->text.find('$')));
  const std::size_t slot = field - row->first_field + 1;
  return std::max(width_of(row->layout), slot < tokens.size() ? trim(tokens[slot]).size() : 0);
}

CardEdit::Row& CardEdit::make_row_of(std::size_t field) {
  for (;;) {
    if (const Row* row = row_of(field)) return rows_[static_cast<std::size_t>(row - rows_.data())];
    // Adds a line behind the last one before the field. A large-field entry may have later lines and no second one.
    const auto last = std::find_if(rows_.rbegin(), rows_.rend(), [&](const Row& row) { return !row.comment && row.first_field <= field; });
    Row row;
    row.layout = last->layout;
    row.first_field = last->first_field + fields_on(last->layout);
    const std::string sign = is_large(row.layout) ? "*" : "+";
    row.text = is_free(row.layout) ? sign : sign + std::string(kNameColumns - 1, ' ');
    row.end = std::exchange(last->end, line_end_);
    rows_.insert(last.base(), std::move(row));
  }
}

void CardEdit::set_columns(Row& row, std::size_t slot, const std::string& value) {
  if (row.text.find('\t') != std::string::npos) row.text = without_tabs(row.text);
  const std::size_t dollar = std::min(row.text.find('$'), row.text.size());
  const std::string comment = row.text.substr(dollar);
  std::string data = row.text.substr(0, dollar);
  const std::size_t width = width_of(row.layout), begin = kNameColumns + slot * width;
  const bool left = leans_left(data, row.layout);
  if (data.size() < begin + width) data.resize(begin + width, ' ');
  data.replace(begin, width, padded(value, std::string_view(data).substr(begin, width), width, left));
  if (comment.empty() && (row.text.size() < data.size() || value.empty())) data.erase(data.find_last_not_of(' ') + 1);
  row.text = data + (comment.empty() || data.size() <= dollar ? "" : " ") + comment;
}

void CardEdit::set_commas(Row& row, std::size_t slot, const std::string& value) {
  const std::size_t dollar = std::min(row.text.find('$'), row.text.size());
  const std::string comment = row.text.substr(dollar);
  std::vector<std::string> tokens = tokens_of(std::string_view(row.text).substr(0, dollar));
  if (tokens.size() < slot + 2) {
    // Blanks before a comment stay there.
    tokens.resize(slot + 2);
  }
  std::string& token = tokens[slot + 1];
  const std::string_view old = trim(token);
  if (old.empty())
    token = value;
  else
    token.replace(static_cast<std::size_t>(old.data() - token.data()), old.size(), value);
  // A field that becomes blank at the end leaves no comma.
  while (value.empty() && tokens.size() > 2 && trim(tokens.back()).empty()) tokens.pop_back();
  row.text.clear();
  for (std::size_t t = 0; t < tokens.size(); ++t) row.text += (t > 0 ? "," : "") + tokens[t];
  row.text += comment;
}

void CardEdit::set(std::size_t field, const std::string& value) {
  Row& row = make_row_of(field);
  if (is_free(row.layout))
    set_commas(row, field - row.first_field, value);
  else
    set_columns(row, field - row.first_field, value);
}

void CardEdit::drop_lines_from(std::size_t field) {
  std::erase_if(rows_, [&](const Row& row) { return !row.comment && row.first_field > 0 && row.first_field >= field; });
  rows_.back().end.clear();
}

std::string CardEdit::text() const {
  std::string out;
  for (const Row& row : rows_) out += row.text + row.end;
  return out;
}

Manner manner_of(std::string_view text, std::size_t offset) {
  const Line line = line_at(text, offset);
  Manner manner;
  manner.layout = layout_of(line.text);
  manner.leans_left = !is_free(manner.layout) && leans_left(line.text, manner.layout);
  manner.line_end = line_end_at(text, offset);
  return manner;
}

std::string write_card(std::string_view name, const std::vector<std::string>& fields, const Manner& manner) {
  std::size_t count = fields.size();
  while (count > 0 && fields[count - 1].empty()) --count;
  const std::size_t on_line = fields_on(manner.layout);
  const bool large = is_large(manner.layout);
  std::string out(name);
  if (large) out += '*';
  // A large-field entry has pairs of lines.
  std::size_t lines = std::max<std::size_t>((count + on_line - 1) / on_line, 1);
  if (large && lines % 2 == 1) ++lines;
  for (std::size_t line = 0; line < lines; ++line) {
    if (line > 0) out += manner.line_end + (large ? "*" : "+");
    const std::size_t first = line * on_line;
    const std::size_t last = std::min(count, first + on_line);
    if (!is_free(manner.layout)) out.append(kNameColumns - std::min(kNameColumns, line == 0 ? name.size() + (large ? 1 : 0) : 1), ' ');
    for (std::size_t f = first; f < last; ++f)
      out += is_free(manner.layout) ? "," + fields[f] : padded(fields[f], {}, width_of(manner.layout), manner.leans_left);
    while (!out.empty() && out.back() == ' ') out.pop_back();
    if (is_free(manner.layout) && first >= last) out += ',';
  }
  return out;
}

}  // namespace prismesh::mesh::deck::nastran

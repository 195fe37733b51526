#include "mesh/deck/lsdyna/shell_writer.h"

#include <algorithm>
#include <cmath>

#include "mesh/deck/lsdyna/field_line.h"
#include "mesh/deck/lsdyna/mesh_cards.h"
#include "mesh/deck/text/format_number.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::lsdyna {
namespace {

constexpr std::array<int, 10> kShellWidths = {8, 8, 8, 8, 8, 8, 8, 8, 8, 8};
constexpr std::array<int, 5> kWrittenThicknessWidths = {16, 16, 16, 16, 16};
constexpr std::array<int, 8> kLayerWidths = {10, 10, 10, 10, 10, 10, 10, 10};

/// The lines of one shell's cards.
struct ShellLines {
  Line main;
  std::vector<Line> thickness;  ///< the second one is of the mid-side nodes
  std::vector<Line> extra;
  std::vector<Line> layers;

  std::size_t end() const {
    const Line& last = !layers.empty() ? layers.back() : !extra.empty() ? extra.back() : !thickness.empty() ? thickness.back() : main;
    return last.offset + last.text.size();
  }
};

/// Where the block ends that a line stands in: at the next line with an asterisk, looked for only as far as cards are read.
bool next_in_block(Lines& lines, Line& line) {
  return lines.next(line) && (line.text.empty() || line.text.front() != '*') &&
         line.text.substr(0, kEncryptedBegin.size()) != kEncryptedBegin;
}

bool has_midside(const FieldLine& main) {
  for (std::size_t field = 6; field < 10; ++field)
    if (!main.is_blank_or_zero(field)) return true;
  return false;
}

ShellLines lines_of_shell(const CardRef& card) {
  const CardForm form = shell_form_of(card.style);
  const Columns columns = columns_of(card.style);
  ShellLines out;
  out.main = {card.text.substr(card.offset, end_of_line(card.text, card.offset) - card.offset), card.offset};
  if (!form.thickness && form.extra_lines == 0 && !form.composite) return out;
  Lines lines(card.text, card.offset, card.text.size());
  Line line;
  lines.next(line);
  if (form.thickness) {
    const int cards = has_midside(FieldLine(out.main.text, kShellWidths, columns)) ? 2 : 1;
    for (int i = 0; i < cards; ++i) {
      if (!next_in_block(lines, line)) return out;
      out.thickness.push_back(line);
    }
  }
  for (int i = 0; i < form.extra_lines; ++i) {
    if (!next_in_block(lines, line)) return out;
    out.extra.push_back(line);
  }
  while (form.composite && next_in_block(lines, line) && !looks_like_element(line.text, columns)) out.layers.push_back(line);
  return out;
}

std::string number_for(double value, const FieldLine& line, std::size_t field, WrittenCard& card) {
  const std::size_t width = line.free_format() ? std::max(line.width(field), line.text(field).size()) : line.width(field);
  std::string text = format_coordinate(value, width);
  double back = 0;
  parse_real(text, back);
  if (back != value) {
    ++card.rounded;
    card.largest_error = std::max(card.largest_error, std::abs(back - value));
  }
  return text;
}

/// An id in its field, left alone where it is the same.
void put_id(FieldLine& line, std::size_t field, std::int64_t id, WrittenCard& card) {
  std::int64_t old = 0;
  if (line.by_parameter(field))
    card.by_parameter = true;
  else if (!parse_integer(line.text(field), old) || old != id)
    line.set(field, std::to_string(id));
}

std::string main_card(const FieldLine& before, const ShellCard& shell, WrittenCard& card) {
  FieldLine line = before;
  const bool triangle = shell.nodes[3] == shell.nodes[2];
  const bool was_short = before.is_blank_or_zero(5);  // a triangle whose fourth node is left out, or 0
  put_id(line, 0, shell.id, card);
  for (std::size_t c = 0; c < 3; ++c) put_id(line, 2 + c, shell.nodes[c], card);
  if (!triangle || !was_short) put_id(line, 5, shell.nodes[3], card);
  return line.str();
}

/// An angle in its field, turned back by as much as the first edge has turned. A blank stays one.
void turn_back(FieldLine& line, std::size_t field, double turn, WrittenCard& card) {
  if (turn == 0 || line.text(field).empty()) return;
  double angle = 0;
  if (line.by_parameter(field) || !parse_real(line.text(field), angle)) {
    card.by_parameter = true;
    return;
  }
  line.set(field, number_for(angle - turn, line, field, card));
  card.turned = true;
}

Result<std::string> thickness_card(const Line& before, const CardForm& form, Columns columns, bool was_triangle, const ShellCard& shell,
                                   WrittenCard& card) {
  FieldLine line(before.text, kWrittenThicknessWidths, columns);
  const FieldLine old = line;
  const std::size_t corners = was_triangle ? 3 : 4;
  std::array<double, 4> thickness{};
  bool differ = false, some_blank = false, some_given = false, readable = true;
  for (std::size_t k = 0; k < corners; ++k) {
    readable &= parse_real(old.text(k), thickness[k]);
    differ |= old.text(k) != old.text(0);
    (thickness[k] > 0 ? some_given : some_blank) = true;
  }
  const bool triangle = shell.nodes[3] == shell.nodes[2];
  // Alike at all corners, by a parameter or not: it is that everywhere.
  if (!differ && was_triangle && !triangle && !old.text(0).empty()) line.set(3, old.text(0));
  if (differ) {
    if (!readable) {
      card.by_parameter = true;
      return line.str();
    }
    if (some_blank && some_given)
      return fail("", "has a thickness of its own at some of its corners only, which can't be mixed with its section's");
    for (std::size_t c = 0; c < 4; ++c) {
      if (c == 3 && triangle && was_triangle) continue;
      const auto whole = std::find(shell.share[c].begin(), shell.share[c].end(), 1.0);
      if (whole != shell.share[c].end()) {
        line.set(c, old.text(static_cast<std::size_t>(whole - shell.share[c].begin())));
        continue;
      }
      double mixed = 0;
      for (std::size_t k = 0; k < corners; ++k) mixed += shell.share[c][k] * thickness[k];
      line.set(c, number_for(mixed, line, c, card));
    }
  }
  if (!form.coordinate_system) turn_back(line, 4, shell.turn_degrees, card);
  return line.str();
}

}  // namespace

std::size_t shell_end(const CardRef& card) { return lines_of_shell(card).end(); }

Result<WrittenCard> write_shell(const CardRef& card, const ShellCard& shell) {
  const CardForm form = shell_form_of(card.style);
  const Columns columns = columns_of(card.style);
  const ShellLines lines = lines_of_shell(card);
  const FieldLine main(lines.main.text, kShellWidths, columns);
  if (has_midside(main)) return fail("", "has mid-side nodes, which can't be divided or changed");
  if (form.scalar_nodes) return fail("", "has scalar nodes at its corners (_DOF), which can't be passed on");
  if (form.thickness && lines.thickness.empty()) return fail("", "lacks the card of thicknesses that its keyword asks for");
  const bool was_triangle = main.is_blank_or_zero(5) || main.text(5) == main.text(4);

  WrittenCard written;
  std::vector<std::string> texts{main_card(main, shell, written)};
  for (const Line& line : lines.thickness) {
    Result<std::string> mixed = thickness_card(line, form, columns, was_triangle, shell, written);
    if (!mixed) return fail(mixed.error());
    texts.push_back(std::move(*mixed));
  }
  for (const Line& line : lines.extra) texts.emplace_back(line.text);
  for (const Line& layer : lines.layers) {
    FieldLine line(layer.text, kLayerWidths, columns);
    turn_back(line, 2, shell.turn_degrees, written);
    if (!form.composite_long) turn_back(line, 6, shell.turn_degrees, written);
    texts.push_back(written.turned ? line.str() : std::string(layer.text));
  }

  // Between the lines stands what stood there: line ends, and, for the shell itself, comments.
  std::int64_t id = 0;
  const bool itself = parse_integer(main.text(0), id) && id == shell.id;
  std::vector<Line> all{lines.main};
  for (const auto* more : {&lines.thickness, &lines.extra, &lines.layers}) all.insert(all.end(), more->begin(), more->end());
  for (std::size_t i = 0; i < all.size(); ++i) {
    written.text += texts[i];
    if (i + 1 == all.size()) break;
    const std::size_t end = all[i].offset + all[i].text.size();
    const std::size_t newline = card.text.find('\n', end);
    written.text += card.text.substr(end, (itself ? all[i + 1].offset : newline + 1) - end);
  }
  return written;
}

}  // namespace prismesh::mesh::deck::lsdyna

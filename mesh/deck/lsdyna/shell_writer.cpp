#include "mesh/deck/lsdyna/shell_writer.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

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
  std::vector<Line> thickness;  ///< at the corners, then at the mid-side nodes
  std::vector<Line> extra;
  std::vector<Line> layers;

  std::size_t end() const {
    const Line& last = !layers.empty() ? layers.back() : !extra.empty() ? extra.back() : !thickness.empty() ? thickness.back() : main;
    return last.offset + last.text.size();
  }
};

/// The next line of the block, which ends before the next keyword or encrypted part. False: there is none.
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

/// Puts an id into its field, unless it is there already.
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

/// Turns an angle back by the turn of the first edge. A blank field stays blank.
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

/// The shell whose cards are written again.
struct ExampleShell {
  CardForm form;
  Columns columns = Columns::standard;
  ShellLines lines;
  FieldLine main;
  bool triangle = false;
};

ExampleShell example_shell(const CardRef& card) {
  const Columns columns = columns_of(card.style);
  ShellLines lines = lines_of_shell(card);
  FieldLine main(lines.main.text, kShellWidths, columns);
  const bool triangle = main.is_blank_or_zero(5) || main.text(5) == main.text(4);
  return {shell_form_of(card.style), columns, std::move(lines), std::move(main), triangle};
}

/// The thicknesses at an example's corners, as its card has them.
struct CornerThickness {
  std::size_t corners = 0;
  std::array<std::string, 4> text;
  std::array<double, 4> value{};
  bool differ = false;
  bool some_blank = false;
  bool some_given = false;
  bool readable = true;
};

CornerThickness corner_thickness(const FieldLine& line, std::size_t corners) {
  CornerThickness out;
  out.corners = corners;
  for (std::size_t k = 0; k < 4; ++k) out.text[k] = line.text(k);
  for (std::size_t k = 0; k < corners; ++k) {
    out.readable &= parse_real(line.text(k), out.value[k]);
    out.differ |= line.text(k) != line.text(0);
    (out.value[k] > 0 ? out.some_given : out.some_blank) = true;
  }
  return out;
}

/// The field of corner `c`: that of one of the example's corners, or all of them mixed by share.
void mix_thickness(FieldLine& line, std::size_t c, const CornerThickness& example, const ShellCard& shell, WrittenCard& card) {
  const auto& share = shell.share[c];
  const auto whole = std::find(share.begin(), share.end(), 1.0);
  if (whole != share.end()) return line.set(c, example.text[static_cast<std::size_t>(whole - share.begin())]);
  double mixed = 0;
  for (std::size_t k = 0; k < example.corners; ++k) mixed += share[k] * example.value[k];
  line.set(c, number_for(mixed, line, c, card));
}

Result<std::string> thickness_card(const Line& before, const ExampleShell& example, const ShellCard& shell, WrittenCard& card) {
  FieldLine line(before.text, kWrittenThicknessWidths, example.columns);
  const CornerThickness thickness = corner_thickness(line, example.triangle ? 3 : 4);
  const bool triangle = shell.nodes[3] == shell.nodes[2];
  // Equal at all corners, also where a parameter gives it: the new corner gets the same.
  if (!thickness.differ && example.triangle && !triangle && !thickness.text[0].empty()) line.set(3, thickness.text[0]);
  if (thickness.differ) {
    if (!thickness.readable) {
      card.by_parameter = true;
      return line.str();
    }
    if (thickness.some_blank && thickness.some_given)
      return fail("", "has a thickness of its own at some of its corners only, which can't be mixed with its section's");
    const std::size_t written = triangle && example.triangle ? 3 : 4;
    for (std::size_t c = 0; c < written; ++c) mix_thickness(line, c, thickness, shell, card);
  }
  if (!example.form.coordinate_system) turn_back(line, 4, shell.turn_degrees, card);
  return line.str();
}

std::string layer_card(const Line& layer, const ExampleShell& example, const ShellCard& shell, WrittenCard& card) {
  FieldLine line(layer.text, kLayerWidths, example.columns);
  turn_back(line, 2, shell.turn_degrees, card);
  if (!example.form.composite_long) turn_back(line, 6, shell.turn_degrees, card);
  return card.turned ? line.str() : std::string(layer.text);
}

/// The new texts of the shell's lines, in their order.
Result<std::vector<std::string>> written_lines(const ExampleShell& example, const ShellCard& shell, WrittenCard& card) {
  std::vector<std::string> out{main_card(example.main, shell, card)};
  for (const Line& line : example.lines.thickness) {
    Result<std::string> mixed = thickness_card(line, example, shell, card);
    if (!mixed) return fail(mixed.error());
    out.push_back(std::move(*mixed));
  }
  for (const Line& line : example.lines.extra) out.emplace_back(line.text);
  for (const Line& layer : example.lines.layers) out.push_back(layer_card(layer, example, shell, card));
  return out;
}

/// Between the lines stands what stood there in the text: line ends, and comments if `comments`.
std::string joined_lines(std::string_view text, const ShellLines& lines, const std::vector<std::string>& written, bool comments) {
  std::vector<Line> all{lines.main};
  for (const auto* more : {&lines.thickness, &lines.extra, &lines.layers}) all.insert(all.end(), more->begin(), more->end());
  std::string out;
  for (std::size_t i = 0; i < all.size(); ++i) {
    out += written[i];
    if (i + 1 == all.size()) break;
    const std::size_t end = all[i].offset + all[i].text.size();
    const std::size_t newline = text.find('\n', end);
    out += text.substr(end, (comments ? all[i + 1].offset : newline + 1) - end);
  }
  return out;
}

}  // namespace

std::size_t shell_end(const CardRef& card) { return lines_of_shell(card).end(); }

Result<WrittenCard> write_shell(const CardRef& card, const ShellCard& shell) {
  const ExampleShell example = example_shell(card);
  if (has_midside(example.main)) return fail("", "has mid-side nodes, which can't be divided or changed");
  if (example.form.scalar_nodes) return fail("", "has scalar nodes at its corners (_DOF), which can't be passed on");
  if (example.form.thickness && example.lines.thickness.empty()) return fail("", "has no thickness card, which its keyword asks for");

  WrittenCard written;
  const Result<std::vector<std::string>> lines = written_lines(example, shell, written);
  if (!lines) return fail(lines.error());
  std::int64_t id = 0;
  const bool itself = parse_integer(example.main.text(0), id) && id == shell.id;
  written.text = joined_lines(card.text, example.lines, *lines, itself);
  return written;
}

}  // namespace prismesh::mesh::deck::lsdyna

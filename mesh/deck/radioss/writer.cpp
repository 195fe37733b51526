#include "mesh/deck/radioss/writer.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "mesh/deck/radioss/block.h"
#include "mesh/deck/radioss/element_writer.h"
#include "mesh/deck/radioss/mesh_cards.h"
#include "mesh/deck/radioss/references.h"
#include "mesh/deck/radioss/shell_groups.h"
#include "mesh/deck/radioss/text_columns.h"
#include "mesh/deck/text/format_number.h"
#include "mesh/deck/text/number.h"
#include "mesh/deck/text/text_lines.h"

namespace prismesh::mesh::deck::radioss {
namespace {

std::string_view first_line(const CardRef& card) { return line_at(card.text, card.offset); }

void put_coordinate(std::size_t width, std::size_t axis, double value, WrittenCard& card) {
  const std::string number = format_coordinate(value, 2 * width);
  double back = 0;
  parse_real(number, back);
  if (back != value) {
    ++card.rounded;
    card.largest_error = std::max(card.largest_error, std::abs(back - value));
  }
  const std::size_t begin = width * (1 + 2 * axis);
  card.by_parameter |= field(card.text, width, 1 + 2 * axis, 2).find('&') != std::string_view::npos;
  put(card.text, begin, 2 * width, number);
}

bool is_triangle(const ShellCard& shell) { return shell.nodes[2] == shell.nodes[3]; }

std::int64_t largest_id(std::size_t width) {
  std::int64_t power = 1;
  for (std::size_t digit = 0; digit < width; ++digit) power *= 10;
  return power - 1;
}

bool is_surface(const Referrer& set) { return set.keyword == "SURF/SEG"; }

/// Changes a set's list of ids, ten a line, or of ranges: first and last (/GENE), or first, last and step (/GEN_INCR).
class IdList {
 public:
  IdList(std::string_view text, const Referrer& set)
      : text_(text),
        width_(width_of(set)),
        steps_(set.keyword.ends_with("/GEN_INCR")),
        ranges_(steps_ || set.keyword.ends_with("/GENE")),
        lines_(list_lines(text, set)) {}

  Result<std::vector<Replacement>> change(std::span<const std::int64_t> joining, std::span<const std::int64_t> leaving) {
    if (lines_.empty()) return fail("", "has no title, so its list can't be found");
    const std::set<std::int64_t> gone(leaving.begin(), leaving.end());
    std::set<std::int64_t> found;
    std::vector<Replacement> out;
    std::size_t kept = 0, last = 0;
    std::vector<std::string> last_fields;
    for (std::size_t l = 1; l < lines_.size(); ++l) {
      std::vector<std::string> fields = fields_of(lines_[l].text);
      const std::size_t before = fields.size();
      std::erase_if(fields, [&](const std::string& one) {
        std::int64_t id = 0;
        if (ranges_ || !parse_integer(one, id) || !gone.contains(id)) return false;
        found.insert(id);
        return true;
      });
      kept += fields.size();
      if (fields.size() != before) replace_line(l, fields, out);
      if (!fields.empty()) last = l, last_fields = std::move(fields);
    }
    if (found.size() < gone.size()) return fail("", "names one of them by a parameter or in an include, so it can't be taken out");
    if (kept + joining.size() == 0) return fail("", "would be left without any");
    if (joining.empty()) return out;
    for (const std::int64_t id : joining)
      if (id > largest_id(width_)) return fail("", "has fields that are too narrow for the new id");
    if (ranges_) return with_ranges(last, joining);
    append(last, std::move(last_fields), joining, out);
    return out;
  }

 private:
  std::vector<std::string> fields_of(std::string_view line) const {
    const std::string plain = without_tabs(line);
    std::vector<std::string> out;
    for (std::size_t f = 0; f < kIdsPerLine && f * width_ < plain.size(); ++f) {
      const std::string_view one = trim(field(plain, width_, f));
      if (!one.empty()) out.emplace_back(one);
    }
    return out;
  }

  std::string line_of(const std::vector<std::string>& fields) const {
    std::string out;
    for (const std::string& one : fields) out += std::string(width_ - std::min(width_, one.size()), ' ') + one;
    return out;
  }

  void replace_line(std::size_t l, const std::vector<std::string>& fields, std::vector<Replacement>& out) const {
    const std::size_t end = lines_[l].offset + lines_[l].text.size();
    const std::size_t next = std::min(text_.find('\n', end), text_.size() - 1) + 1;
    out.push_back({lines_[l].offset, (fields.empty() ? next : end) - lines_[l].offset, line_of(fields)});
  }

  /// Adds a line behind the last for each range of consecutive ids.
  std::vector<Replacement> with_ranges(std::size_t last, std::span<const std::int64_t> joining) const {
    const std::size_t end = lines_[last].offset + lines_[last].text.size();
    std::string added;
    for (std::size_t i = 0, next = 0; i < joining.size(); i = next) {
      for (next = i + 1; next < joining.size() && joining[next] == joining[next - 1] + 1;) ++next;
      std::vector<std::string> range = {std::to_string(joining[i]), std::to_string(joining[next - 1])};
      if (steps_) range.emplace_back("1");
      added += line_end_at(text_, end) + line_of(range);
    }
    return {{end, 0, std::move(added)}};
  }

  /// Fills the last line that stays, then adds lines.
  void append(std::size_t last, std::vector<std::string> fields, std::span<const std::int64_t> joining,
              std::vector<Replacement>& out) const {
    std::size_t next = 0;
    const ListLine& line = lines_[last];
    const std::size_t end = line.offset + line.text.size();
    std::string added;
    if (last > 0)
      while (fields.size() < kIdsPerLine && next < joining.size()) fields.push_back(std::to_string(joining[next++]));
    std::string first = last > 0 ? line_of(fields) : std::string(line.text);
    while (next < joining.size()) {
      std::vector<std::string> more;
      while (more.size() < kIdsPerLine && next < joining.size()) more.push_back(std::to_string(joining[next++]));
      added += line_end_at(text_, end) + line_of(more);
    }
    std::erase_if(out, [&](const Replacement& replacement) { return replacement.offset == line.offset; });
    out.push_back({line.offset, line.text.size(), first + added});
    std::sort(out.begin(), out.end(), [](const Replacement& a, const Replacement& b) { return a.offset < b.offset; });
  }

  std::string_view text_;
  std::size_t width_;
  bool steps_;
  bool ranges_;
  std::vector<ListLine> lines_;
};

class Writer : public CardWriter {
 public:
  std::size_t node_end(const CardRef& card) const override { return end_of_line(card.text, card.offset); }
  std::size_t shell_end(const CardRef& card) const override { return end_of_line(card.text, card.offset); }

  std::optional<Vec3> node_coordinates(const CardRef& card) const override {
    const std::string line = without_tabs(first_line(card));
    Vec3 out;
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (!parse_real(field(line, Style::of(card.style).width(), 1 + 2 * axis, 2), out[static_cast<Eigen::Index>(axis)]))
        return std::nullopt;
    return out;
  }

  WrittenCard move_node(const CardRef& card, const Vec3& from, const Vec3& to) const override {
    WrittenCard written;
    written.text = without_tabs(first_line(card));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<Eigen::Index>(axis);
      if (from[a] != to[a]) put_coordinate(Style::of(card.style).width(), axis, to[a], written);
    }
    return written;
  }

  WrittenCard new_node(const CardRef& example, std::int64_t id, const Vec3& at) const override {
    const std::size_t width = Style::of(example.style).width();
    WrittenCard written;
    put(written.text, 0, width, std::to_string(id));
    for (std::size_t axis = 0; axis < 3; ++axis) put_coordinate(width, axis, at[static_cast<Eigen::Index>(axis)], written);
    return written;
  }

  Result<WrittenCard> shell(const CardRef& card, const ShellCard& shell) const override {
    const Style own = Style::of(card.style);
    const std::string line = without_tabs(first_line(card));
    if (is_triangle(shell) != own.triangle)
      return fail("", own.triangle ? "stands in an /SH3N block, which holds triangles only"
                                   : "stands in a /SHELL block, where a triangle's own block is /SH3N");
    return with_corners(line, own, shell);
  }

  bool holds_triangles_and_quads(const CardRef&) const override { return false; }

  Result<WrittenCard> shell_in_manner(const CardRef& card, const CardRef& example, const ShellCard& shell) const override {
    const Style own = Style::of(card.style);
    const Style wanted = Style::of(example.style);
    if (is_triangle(shell) != wanted.triangle) return fail("", "has another number of corners than the block it would go to");
    if (own.old != wanted.old) return fail("", "would go to a block with columns of another width");
    // Angle and thickness stand in the same columns in both blocks; text between the corners and them is removed.
    std::string line = without_tabs(first_line(card));
    const std::size_t width = own.width();
    if (line.size() > 4 * width)
      line.replace(4 * width, std::min(line.size(), 6 * width) - 4 * width, std::string(std::min(line.size(), 6 * width) - 4 * width, ' '));
    return with_corners(std::move(line), wanted, shell);
  }

  /// Quads and triangles have different keywords for groups and histories.
  bool can_name(const Referrer& card, bool triangle) const override {
    const auto begins = [&](std::string_view word) { return card.keyword.compare(0, word.size(), word) == 0; };
    if (begins("GRSHEL") || begins("TH/SHEL")) return !triangle;
    return !begins("GRSH3N") && !begins("TH/SH3N") ? true : triangle;
  }

  Result<std::optional<std::uint32_t>> companion(const Deck& deck, std::uint32_t set) const override {
    return groups_of(deck).companion(set);
  }
  std::vector<FileReplacement> new_companion(const Deck& deck, std::uint32_t set, std::span<const std::int64_t> ids) const override {
    return groups_of(deck).new_companion(set, ids);
  }

  /// "/SHELL/7" and "/SH3N/7" hold the shells of one part in the same file.
  Result<NewBlock> block_of_kind(const CardRef& card, bool triangles) const override {
    const BlockFinder::BlockRange found = blocks_.at(card.text, card.offset);
    if (found.has_keyword && card.text[found.keyword] == '#') return fail("", "stands in a block that an include interrupts");
    NewBlock block;
    block.header = std::string(line_at(card.text, found.keyword));
    const std::size_t slash = block.header.find('/', 1);
    if (slash == std::string::npos || !found.has_keyword) return fail("", "has no keyword that could be found");
    block.header.replace(0, slash, triangles ? "/SH3N" : "/SHELL");
    // At the next keyword, behind comments: these may belong to the block's last card.
    block.offset = found.end;
    if (is_include(card.text.substr(block.offset))) return fail("", "stands in a block that goes on in an include");
    return block;
  }

  Result<WrittenCard> shell_in_block(const CardRef& card, const ShellCard& shell) const override {
    Style other = Style::of(card.style);
    other.triangle = !other.triangle;
    return shell_in_manner(card, {card.text, card.offset, other.number()}, shell);
  }

  Result<std::vector<Replacement>> join(std::string_view text, const Referrer& set, std::span<const std::int64_t> ids) const override {
    return change_list(text, set, ids, {});
  }

  Result<std::vector<Replacement>> change_list(std::string_view text, const Referrer& set, std::span<const std::int64_t> joining,
                                               std::span<const std::int64_t> leaving) const override {
    if (adds_to_ids(set.style)) return fail("", "stands in a submodel that adds to its ids, so its list can't be changed");
    return IdList(text, set).change(joining, leaving);
  }

  std::optional<std::array<std::int64_t, 4>> segment(std::string_view text, const Referrer& set, std::size_t card) const override {
    if (adds_to_ids(set.style) || !is_surface(set)) return std::nullopt;
    const std::string line = without_tabs(line_at(text, card));
    std::array<std::int64_t, 4> out{};
    for (std::size_t c = 0; c < 4; ++c)
      if (!parse_integer(field(line, width_of(set), 1 + c), out[c])) return std::nullopt;
    if (out[3] == 0) out[3] = out[2];
    return out;
  }

  Result<std::vector<Replacement>> replace_segment(std::string_view text, const Referrer& set, std::size_t card,
                                                   std::span<const std::array<std::int64_t, 4>> with) const override {
    if (adds_to_ids(set.style)) return fail("", "stands in a submodel that adds to its ids, so its segments can't be changed");
    if (!is_surface(set)) return fail("", "is a line, whose segments can't be divided");
    const std::size_t width = width_of(set);
    const std::size_t end = end_of_line(text, card);
    const std::string line = without_tabs(text.substr(card, end - card));
    for (const auto& corners : with)
      if (*std::max_element(corners.begin(), corners.end()) > largest_id(width))
        return fail("", "has fields that are too narrow for the new id");
    std::int64_t last_id = 0;
    const std::vector<ListLine> lines = list_lines(text, set);
    for (std::size_t l = 1; l < lines.size(); ++l) {
      std::int64_t id = 0;
      if (parse_integer(field(without_tabs(lines[l].text), width, 0), id)) last_id = std::max(last_id, id);
    }
    std::string out;
    for (std::size_t i = 0; i < with.size(); ++i) {
      std::string segment = line;
      if (i > 0 && ++last_id > largest_id(width)) return fail("", "has no room for the number of one more segment");
      if (i > 0) put_id(segment, 0, width, last_id);
      for (std::size_t c = 0; c < 4; ++c) put_id(segment, (1 + c) * width, width, with[i][c]);
      out += (i > 0 ? line_end_at(text, end) : "") + segment;
    }
    const std::size_t removed = with.empty() ? std::min(text.find('\n', end), text.size() - 1) + 1 : end;
    return std::vector<Replacement>{{card, removed - card, std::move(out)}};
  }

  /// A submodel may be a part of a file. Cards in a submodel that adds to ids aren't changed.
  bool shifts_whole_files() const override { return false; }

  /// Cards that name a single one (main nodes, histories, sections, directions) go on naming it. In a group such an id is one that is
  /// removed from it, and whether its successors are isn't known.
  Inheritance inheritance(const Referrer& card, Referred) const override {
    return card.keyword.substr(0, 2) == "GR" ? Inheritance::forbids : Inheritance::stays;
  }

  Result<ElementPlace> find_element(const Deck& deck, ElementClass element_class, std::int64_t id,
                                    std::span<const std::int64_t> nodes) const override {
    return radioss::find_element(deck, element_class, id, nodes);
  }
  Result<WrittenCard> element_like(std::string_view text, const ElementPlace& example, const ElementCard& element) const override {
    return radioss::element_like(text, example, element);
  }

  std::int64_t largest_node_id(std::uint16_t style) const override { return largest_id(Style::of(style).width()); }
  std::int64_t largest_shell_id(std::uint16_t style) const override { return largest_node_id(style); }

 private:
  /// An include in the middle of a block ends what can be changed in the text. Behind "#enddata" nothing is read.
  static bool ends_block(std::string_view text, std::size_t line) {
    return text[line] == '/' || is_include(text.substr(line)) || text.substr(line).starts_with(kEndOfData);
  }
  mutable BlockFinder blocks_{ends_block};

  const ShellGroups& groups_of(const Deck& deck) const {
    if (groups_deck_ != &deck) groups_.emplace(deck);
    groups_deck_ = &deck;
    return *groups_;
  }
  mutable std::optional<ShellGroups> groups_;
  mutable const Deck* groups_deck_ = nullptr;

  static Result<WrittenCard> with_corners(std::string line, const Style& style, const ShellCard& shell) {
    WrittenCard card;
    const std::size_t width = style.width();
    const std::size_t corners = style.triangle ? 3 : 4;
    card.text = std::move(line);
    if (field(card.text, width, 0, 1 + corners).find('&') != std::string_view::npos)
      return fail("", "has ids given by a parameter, which can't be changed here");
    put_id(card.text, 0, width, shell.id);
    for (std::size_t c = 0; c < corners; ++c) put_id(card.text, (1 + c) * width, width, shell.nodes[c]);
    return card;
  }

  static void put_id(std::string& line, std::size_t begin, std::size_t width, std::int64_t id) {
    std::int64_t old = 0;
    if (begin < line.size() && parse_integer(std::string_view(line).substr(begin, width), old) && old == id) return;
    put(line, begin, width, std::to_string(id));
  }
};

}  // namespace

std::unique_ptr<const CardWriter> card_writer() { return std::make_unique<Writer>(); }

}  // namespace prismesh::mesh::deck::radioss

#include "mesh/deck/abaqus/writer.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "mesh/deck/abaqus/card_fields.h"
#include "mesh/deck/abaqus/element_writer.h"
#include "mesh/deck/abaqus/keyword.h"
#include "mesh/deck/abaqus/mesh_cards.h"
#include "mesh/deck/abaqus/part_cards.h"
#include "mesh/deck/abaqus/references.h"
#include "mesh/deck/text/format_number.h"
#include "mesh/deck/text/number.h"
#include "mesh/deck/text/text_lines.h"

namespace prismesh::mesh::deck::abaqus {
namespace {

/// "Floating point numbers can occupy 20 spaces at most, including the sign, the point and the exponent."
constexpr std::size_t kNumberWidth = 20;
constexpr std::int64_t kMaxId = 999'999'999;

/// The card's first line, without its end.
std::string_view first_line(const CardRef& card) {
  return card.text.substr(card.offset, end_of_line(card.text, card.offset) - card.offset);
}

std::string number_text(double value, WrittenCard& card) {
  std::string text = format_coordinate(value, kNumberWidth);
  double back = 0;
  if (!parse_real(text, back) || back != value) {
    ++card.rounded;
    card.largest_error = std::max(card.largest_error, std::abs(back - value));
  }
  return text;
}

/// The element type that corresponds to `type` and has three or four corners; empty: there is none.
std::string other_type(std::string_view type, bool triangles) {
  constexpr std::pair<std::string_view, std::string_view> kPairs[] = {
      {"S4R", "S3R"},    {"S4", "S3"},     {"S4RS", "S3RS"},  {"M3D4R", "M3D3"}, {"M3D4", "M3D3"}, {"R3D4", "R3D3"},
      {"CPS4R", "CPS3"}, {"CPS4", "CPS3"}, {"CPE4R", "CPE3"}, {"CPE4", "CPE3"},  {"DS4", "DS3"}};
  for (const auto& [quad, triangle] : kPairs) {
    if (triangles && type == quad) return std::string(triangle);
    if (!triangles && type == triangle) return std::string(quad);
  }
  return "";
}

bool is_keyword(std::string_view text, std::size_t line) {
  const std::string_view rest = text.substr(std::min(text.find_first_not_of(" \t", line), text.size()), 2);
  return rest.substr(0, 1) == "*" && rest != "**";
}

/// A block's keyword with its parameters, without the end of its last line.
std::string header_of(std::string_view text, const BlockFinder::BlockRange& block) {
  Keywords keywords(text.substr(block.keyword));
  Keyword keyword;
  if (!keywords.next(keyword)) return {};
  const std::string_view header = text.substr(block.keyword, keyword.end);
  return std::string(header.substr(0, header.find_last_not_of(" \r\n") + 1));
}

/// A keyword line without one of its parameters.
std::string without_parameter(std::string_view header, std::string_view name) {
  std::string out;
  for (std::size_t begin = 0; begin <= header.size();) {
    std::size_t end = begin;
    for (bool quoted = false; end < header.size() && (quoted || header[end] != ','); ++end) quoted ^= header[end] == '"';
    const std::string_view parameter = header.substr(begin, end - begin);
    if (label(trim(parameter.substr(0, parameter.find('=')))) != name) out += (begin > 0 ? "," : "") + std::string(parameter);
    begin = end + 1;
  }
  return out;
}

/// The fields of a line that hold none of `ids`.
std::vector<FieldRange> without_ids(std::string_view line, std::vector<FieldRange> places, std::span<const std::int64_t> ids) {
  std::erase_if(places, [&](const FieldRange& place) {
    std::int64_t id = 0;
    return parse_integer(trim(line.substr(place.begin, place.length)), id) && std::find(ids.begin(), ids.end(), id) != ids.end();
  });
  return places;
}

/// The line with some of its fields only; its begin and end stay.
std::string line_of(std::string_view line, const std::vector<FieldRange>& places) {
  std::string out(line.substr(0, line.find_first_not_of(" \t")));
  for (const FieldRange& place : places) {
    const std::string_view field = line.substr(place.begin, place.length);
    out += out.find_first_not_of(" \t") == std::string::npos ? std::string(trim(field)) : "," + std::string(field);
  }
  return out + (trim(line).back() == ',' ? "," : "");
}

class Writer : public CardWriter {
 public:
  std::size_t node_end(const CardRef& card) const override { return std::max(end_of_line(card.text, card.offset), card.offset); }

  std::size_t shell_end(const CardRef& card) const override {
    std::size_t end = card.offset;
    cut_card(card.text, card.offset, nodes_of(card.style) + 1, end);
    return end;
  }

  std::optional<Vec3> node_coordinates(const CardRef& card) const override {
    const auto fields = first_fields<4>(first_line(card));
    Vec3 out;
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (!parse_real(fields[axis + 1], out[static_cast<Eigen::Index>(axis)])) return std::nullopt;
    return out;
  }

  WrittenCard move_node(const CardRef& card, const Vec3& from, const Vec3& to) const override {
    WrittenCard written;
    written.text = std::string(first_line(card));
    for (std::size_t axis = 3; axis-- > 0;) {
      const auto a = static_cast<Eigen::Index>(axis);
      if (from[a] != to[a]) put_coordinate(written, axis, to[a]);
    }
    return written;
  }

  WrittenCard new_node(const CardRef& card, std::int64_t id, const Vec3& at) const override {
    WrittenCard written;
    written.text = std::string(first_line(card));
    std::vector<FieldRange> places = places_of_line(written.text, 0);
    // Behind the coordinates stands the old node's normal.
    if (places.size() > 4) written.text.resize(places[3].begin + places[3].length);
    for (std::size_t axis = 3; axis-- > 0;) put_coordinate(written, axis, at[static_cast<Eigen::Index>(axis)]);
    written.by_parameter = false;
    const std::string_view old = std::string_view(written.text).substr(places[0].begin, places[0].length);
    const std::string put = in_place_of(old, std::to_string(id), starts_with_blanks(old));
    written.text.replace(places[0].begin, places[0].length, put);
    return written;
  }

  Result<WrittenCard> shell(const CardRef& card, const ShellCard& shell) const override {
    if ((card.style & kStyleMidside) != 0) return fail("", "has mid-side nodes, which would be missing from a changed or new one");
    if ((card.style & kStyleShifted) != 0)
      return fail("", "belongs to an instance whose numbers are shown changed, or to a part with several");
    const bool triangle = shell.nodes[3] == shell.nodes[2];
    const std::size_t corners = nodes_of(card.style);
    if (triangle && corners == 4) return fail("", "is of a type with four corners, so a triangle can't be written like it");
    if (!triangle && corners == 3) return fail("", "is of a type with three corners, so a quad can't be written like it");
    std::size_t end = card.offset;
    const std::vector<FieldRange> places = cut_card(card.text, card.offset, corners + 1, end);
    if (places.size() < corners + 1) return fail("", "has a card that can't be read");
    WrittenCard written;
    written.text = std::string(card.text.substr(card.offset, end - card.offset));
    for (std::size_t f = corners + 1; f-- > 0;) {
      const std::string_view old = card.text.substr(places[f].begin, places[f].length);
      const std::int64_t id = f == 0 ? shell.id : shell.nodes[f - 1];
      std::int64_t now = 0;
      if (old.find('<') != std::string_view::npos) {
        written.by_parameter = true;
      } else if (!parse_integer(trim(old), now) || now != id) {
        written.text.replace(places[f].begin - card.offset, places[f].length,
                             in_place_of(old, std::to_string(id), starts_with_blanks(old)));
      }
    }
    return written;
  }

  bool holds_triangles_and_quads(const CardRef&) const override { return false; }

  /// The set that the keyword puts its nodes into: "*NODE, NSET=rim".
  std::string node_constraints(const CardRef& card) const override {
    const BlockFinder::BlockRange block = blocks_.at(card.text, card.offset);
    Keywords keywords(card.text.substr(block.keyword));
    Keyword keyword;
    if (block.has_keyword && keywords.next(keyword) && keyword.name == "NODE")
      return label(Parameters(card.text, block.keyword, block.keyword + keyword.end).value("NSET").value_or(""));
    // The keyword stands in another file, or an include is between. It applies to all cards here.
    return "as others at " + std::to_string(reinterpret_cast<std::uintptr_t>(card.text.data()) + block.keyword);
  }

  Result<WrittenCard> new_constrained_node(const CardRef& card, std::int64_t id, const Vec3& at) const override {
    return new_node(card, id, at);
  }

  bool constraints_must_agree() const override { return false; }

  /// A keyword like the one above the card, but for its NSET.
  std::optional<NewBlock> block_without_constraints(const CardRef& card) const override {
    const BlockFinder::BlockRange block = blocks_.at(card.text, card.offset);
    const std::string header = block.has_keyword ? header_of(card.text, block) : "";
    const std::string without = without_parameter(header, "NSET");
    if (header == without) return std::nullopt;
    return NewBlock{block.end, without};
  }

  /// A keyword like the one above the card, but for its TYPE.
  Result<NewBlock> block_of_kind(const CardRef& card, bool triangles) const override {
    const BlockFinder::BlockRange found = blocks_.at(card.text, card.offset);
    if (!found.has_keyword) return fail("", "has no keyword above it in its file");
    NewBlock block{found.end, header_of(card.text, found)};
    std::string upper = block.header;
    for (char& c : upper)
      if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    if (upper.compare(0, 8, "*ELEMENT") != 0 || upper.find("INPUT") != std::string::npos)
      return fail("", "has no keyword above it in its file");
    const std::size_t type = upper.find("TYPE");
    const std::size_t equals = type == std::string::npos ? type : upper.find('=', type);
    if (equals == std::string::npos) return fail("", "has a keyword that names no type");
    const std::size_t first = upper.find_first_not_of(" \t", equals + 1);
    const std::size_t last = std::min(upper.find_first_of(", \t\r\n", first), upper.size());
    const std::string other = other_type(upper.substr(first, last - first), triangles);
    if (other.empty()) return fail("", "is of a type that has no other with " + std::string(triangles ? "three" : "four") + " corners");
    block.header.replace(first, last - first, other);
    return block;
  }

  Result<WrittenCard> shell_in_block(const CardRef& card, const ShellCard& shell) const override {
    if ((card.style & kStyleMidside) != 0) return fail("", "has mid-side nodes, which would be missing from a changed or new one");
    if ((card.style & kStyleShifted) != 0)
      return fail("", "belongs to an instance whose numbers are shown changed, or to a part with several");
    const std::size_t corners = nodes_of(card.style), wanted = shell.nodes[3] == shell.nodes[2] ? 3 : 4;
    std::size_t end = card.offset;
    const std::vector<FieldRange> places = cut_card(card.text, card.offset, corners + 1, end);
    if (places.size() < corners + 1) return fail("", "has a card that can't be read");
    WrittenCard written;
    for (std::size_t f = 0; f <= wanted; ++f) {
      const std::string_view old = f <= corners ? card.text.substr(places[f].begin, places[f].length) : std::string_view(" ");
      written.by_parameter |= old.find('<') != std::string_view::npos;
      const bool one_line = old.find('\n') == std::string_view::npos;
      const std::string id = std::to_string(f == 0 ? shell.id : shell.nodes[f - 1]);
      written.text += (f > 0 ? "," : "") + (one_line && !trim(old).empty() ? in_place_of(old, id, starts_with_blanks(old)) : " " + id);
    }
    return written;
  }

  Result<std::vector<Replacement>> change_list(std::string_view text, const Referrer& set, std::span<const std::int64_t> joining,
                                               std::span<const std::int64_t> leaving) const override {
    Result<std::vector<Replacement>> out = join(text, set, joining);
    if (!out || leaving.empty()) return out;
    std::size_t found = 0, kept = 0;
    DataLines lines(text, tail_of(text, set).first, static_cast<std::size_t>(set.end));
    std::vector<Replacement> shorter;
    for (DataLine line; lines.next(line);) {
      const std::vector<FieldRange> places = places_of_line(line.text, 0);
      const std::vector<FieldRange> stay = without_ids(line.text, places, leaving);
      kept += stay.size();
      found += places.size() - stay.size();
      if (stay.size() == places.size()) continue;
      const std::size_t next = std::min(text.find('\n', line.offset), text.size() - 1) + 1;
      if (stay.empty())
        shorter.push_back({line.offset, next - line.offset, ""});
      else
        shorter.push_back({line.offset, line.text.size(), line_of(line.text, stay)});
    }
    if (found != leaving.size()) return fail("", "names what would go twice, or in an include");
    if (kept + joining.size() == 0) return fail("", "would be left empty");
    out->insert(out->begin(), shorter.begin(), shorter.end());
    return out;
  }

  Result<std::vector<Replacement>> join(std::string_view text, const Referrer& set, std::span<const std::int64_t> ids) const override {
    if ((set.style & kStyleNamesAndIds) != 0) return fail("", "isn't a set that lists what it has");
    if ((set.style & kStyleOtherIds) != 0) return fail("", "belongs to a part whose numbers are shown changed, or shown several times");
    if (ids.empty()) return std::vector<Replacement>();
    const ListTail tail = tail_of(text, set);
    std::string lines;
    std::size_t on_line = 0;
    const bool generate = (set.style & kStyleGenerate) != 0;
    for (const std::int64_t id : ids) {
      if (!lines.empty()) {
        if (!generate && on_line < kIdsOnALine) {
          lines += tail.between;
        } else {
          lines += tail.line_end;
          on_line = 0;
        }
      }
      if (on_line == 0) lines += tail.before;
      lines += std::to_string(id);
      if (generate) lines += tail.between + std::to_string(id) + tail.between + "1";
      ++on_line;
    }
    const bool unended = tail.at == text.size() && tail.at > 0 && text[tail.at - 1] != '\n';
    return std::vector<Replacement>{{tail.at, 0, unended ? tail.line_end + lines : lines + tail.line_end}};
  }

  Result<ElementPlace> find_element(const Deck& deck, ElementClass element_class, std::int64_t id,
                                    std::span<const std::int64_t> nodes) const override {
    return abaqus::find_element(deck, element_class, id, nodes);
  }
  Result<WrittenCard> element_like(std::string_view text, const ElementPlace& example, const ElementCard& element) const override {
    return abaqus::element_like(text, example, element);
  }
  std::size_t end_of_cards(std::string_view text) const override { return abaqus::end_of_model(text); }
  Result<std::string> element_header(ElementClass element_class, const Part& part) const override {
    return abaqus::element_header(element_class, part);
  }
  Result<WrittenCard> new_element(std::string_view, ElementClass, const ElementCard& element) const override {
    return abaqus::new_element(element);
  }
  ElementClass weld_class() const override { return ElementClass::discrete; }
  Result<std::pair<Part, std::string>> weld_part(const Deck& deck, const Model& model, const WeldPart& wanted) const override {
    return abaqus::weld_part(deck, model, wanted);
  }
  Result<std::pair<Part, std::string>> bond_part(const Deck& deck, const Model& model, const BondPart& wanted) const override {
    return abaqus::bond_part(deck, model, wanted);
  }

  std::int64_t largest_node_id(std::uint16_t style) const override { return (style & kStyleShifted) != 0 ? 0 : kMaxId; }
  std::int64_t largest_shell_id(std::uint16_t style) const override { return (style & kStyleShifted) != 0 ? 0 : kMaxId; }

 private:
  mutable BlockFinder blocks_{is_keyword};

  /// The format of a set's lines, and where the next one goes.
  struct ListTail {
    std::size_t first = 0;  ///< behind the keyword
    std::size_t at = 0;
    std::string before;          ///< blanks at the line's beginning
    std::string between = ", ";  ///< two numbers
    std::string line_end = "\n";
  };

  static ListTail tail_of(std::string_view text, const Referrer& set) {
    ListTail tail;
    Keywords keywords(text.substr(static_cast<std::size_t>(set.offset), static_cast<std::size_t>(set.end - set.offset)));
    Keyword keyword;
    std::size_t data = static_cast<std::size_t>(set.end);
    if (keywords.next(keyword)) data = static_cast<std::size_t>(set.offset) + keyword.end;
    tail.first = tail.at = data;
    DataLines lines(text, data, static_cast<std::size_t>(set.end));
    DataLine last;
    for (DataLine line; lines.next(line);) last = line;
    if (!last.text.empty()) {
      const std::size_t end = text.find('\n', last.offset);
      tail.at = end == std::string_view::npos ? text.size() : end + 1;
      const std::string_view first = trim(last.text);
      tail.before = std::string(last.text.substr(0, static_cast<std::size_t>(first.data() - last.text.data())));
      const std::size_t comma = first.find(',');
      if (comma != std::string_view::npos && comma + 1 < first.size()) {
        const std::size_t blanks = first.find_first_not_of(" \t", comma + 1);
        tail.between =
            "," +
            std::string(blanks == std::string_view::npos ? " " : first.substr(comma + 1, std::min<std::size_t>(blanks - comma - 1, 1)));
      }
    }
    const std::size_t line = text.find('\n', static_cast<std::size_t>(set.offset));
    if (line != std::string_view::npos && line > 0 && text[line - 1] == '\r') tail.line_end = "\r\n";
    return tail;
  }

  static std::size_t nodes_of(std::uint16_t style) {
    const std::size_t corners = style & kStyleCorners;
    return (style & kStyleMidside) != 0 ? 2 * corners : corners;
  }

  static void put_coordinate(WrittenCard& card, std::size_t axis, double value) {
    std::vector<FieldRange> places = places_of_line(card.text, 0);
    if (places.size() < axis + 2) {
      // Missing fields are zero.
      if (!places.empty() && trim(card.text).back() == ',') card.text.erase(card.text.find_last_of(','));
      while (places.size() < axis + 2) {
        card.text += ",";
        places.push_back({card.text.size(), 0});
      }
    }
    const FieldRange place = places[axis + 1];
    const std::string old = card.text.substr(place.begin, place.length);
    card.by_parameter |= old.find('<') != std::string::npos;
    bool column = false;
    for (std::size_t f = 1; f < std::min<std::size_t>(places.size(), 4); ++f)
      column |= starts_with_blanks(std::string_view(card.text).substr(places[f].begin, places[f].length));
    card.text.replace(place.begin, place.length, in_place_of(old, number_text(value, card), column));
  }
};

}  // namespace

std::unique_ptr<const CardWriter> card_writer() { return std::make_unique<Writer>(); }

}  // namespace prismesh::mesh::deck::abaqus

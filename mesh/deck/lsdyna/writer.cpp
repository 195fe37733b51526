#include "mesh/deck/lsdyna/writer.h"

#include <algorithm>
#include <cmath>

#include "mesh/deck/lsdyna/element_writer.h"
#include "mesh/deck/lsdyna/field_line.h"
#include "mesh/deck/lsdyna/mesh_cards.h"
#include "mesh/deck/lsdyna/parameters.h"
#include "mesh/deck/lsdyna/set_writer.h"
#include "mesh/deck/lsdyna/shell_writer.h"
#include "mesh/deck/lsdyna/weld_cards.h"
#include "mesh/deck/text/format_number.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::lsdyna {
namespace {

constexpr std::array<int, 6> kWrittenNodeWidths = {8, 16, 16, 16, 8, 8};

std::string number_for(double value, std::size_t width, WrittenCard& card) {
  std::string text = format_coordinate(value, width);
  double back = 0;
  parse_real(text, back);
  if (back != value) {
    ++card.rounded;
    card.largest_error = std::max(card.largest_error, std::abs(back - value));
  }
  return text;
}

}  // namespace

WrittenCard rewrite_node_card(std::string_view line, Columns columns, const Vec3& from, const Vec3& to) {
  WrittenCard card;
  FieldLine fields(line, kWrittenNodeWidths, columns);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    if (from[a] == to[a]) continue;
    card.by_parameter |= fields.by_parameter(axis + 1);
    const std::size_t width = fields.width(axis + 1);
    fields.set(axis + 1, number_for(to[a], fields.free_format() ? std::max(width, fields.text(axis + 1).size()) : width, card));
  }
  card.text = fields.str();
  return card;
}

namespace {

class Writer : public CardWriter {
 public:
  std::size_t node_end(const CardRef& card) const override { return end_of_line(card.text, card.offset); }

  std::size_t shell_end(const CardRef& card) const override { return lsdyna::shell_end(card); }

  std::optional<Vec3> node_coordinates(const CardRef& card) const override {
    Card fields;
    fields.cut(line_of(card), kWrittenNodeWidths, columns_of(card.style));
    const Parameters none;
    Vec3 out;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::optional<double> value = fields.real(axis + 1, none);
      if (!value) return std::nullopt;
      out[static_cast<Eigen::Index>(axis)] = *value;
    }
    return out;
  }

  WrittenCard move_node(const CardRef& card, const Vec3& from, const Vec3& to) const override {
    return rewrite_node_card(line_of(card), columns_of(card.style), from, to);
  }

  WrittenCard new_node(const CardRef& card, std::int64_t id, const Vec3& at) const override { return new_card(card, id, at, false); }

  /// TC and RC, unless both are blank or zero.
  std::string node_constraints(const CardRef& card) const override {
    const FieldLine line(line_of(card), kWrittenNodeWidths, columns_of(card.style));
    if (line.is_blank_or_zero(4) && line.is_blank_or_zero(5)) return {};
    return std::string(line.text(4)) + "," + std::string(line.text(5));
  }

  Result<WrittenCard> new_constrained_node(const CardRef& card, std::int64_t id, const Vec3& at) const override {
    return new_card(card, id, at, true);
  }

  Result<WrittenCard> shell(const CardRef& card, const ShellCard& shell) const override { return write_shell(card, shell); }

  bool holds_triangles_and_quads(const CardRef&) const override { return true; }

  Result<std::vector<Replacement>> join(std::string_view text, const Referrer& set, std::span<const std::int64_t> ids) const override {
    return change_set(text, set, ids, {});
  }
  Result<std::vector<Replacement>> change_list(std::string_view text, const Referrer& set, std::span<const std::int64_t> joining,
                                               std::span<const std::int64_t> leaving) const override {
    return change_set(text, set, joining, leaving);
  }
  std::optional<std::array<std::int64_t, 4>> segment(std::string_view text, const Referrer& set, std::size_t card) const override {
    return read_segment(text, set, card);
  }
  Result<std::vector<Replacement>> replace_segment(std::string_view text, const Referrer& set, std::size_t card,
                                                   std::span<const std::array<std::int64_t, 4>> with) const override {
    return lsdyna::replace_segment(text, set, card, with);
  }
  Inheritance inheritance(const Referrer& card, Referred referred) const override { return inheritance_of(card, referred); }
  Result<std::vector<Replacement>> copy_single(std::string_view text, const Referrer& card, const Reference& single,
                                               std::span<const std::int64_t> ids) const override {
    return lsdyna::copy_single(text, card, single, ids);
  }

  Result<ElementPlace> find_element(const Deck& deck, ElementClass element_class, std::int64_t id,
                                    std::span<const std::int64_t> nodes) const override {
    return lsdyna::find_element(deck, element_class, id, nodes);
  }
  Result<WrittenCard> element_like(std::string_view text, const ElementPlace& example, const ElementCard& element) const override {
    return lsdyna::element_like(text, example, element);
  }
  std::size_t end_of_cards(std::string_view text) const override { return lsdyna::end_of_cards(text); }
  Result<std::string> element_header(ElementClass element_class, const Part&) const override {
    return element_class == ElementClass::solid ? "*ELEMENT_SOLID" : "*ELEMENT_BEAM";
  }
  Result<WrittenCard> new_element(std::string_view text, ElementClass element_class, const ElementCard& element) const override {
    return lsdyna::new_element(text, element_class, element);
  }

  Result<std::pair<Part, std::string>> weld_part(const Deck& deck, const Model& model, const WeldPart& wanted) const override {
    return lsdyna::weld_part(deck, model, wanted);
  }

  Result<std::pair<Part, std::string>> bond_part(const Deck& deck, const Model& model, const BondPart& wanted) const override {
    return lsdyna::bond_part(deck, model, wanted);
  }

  std::int64_t largest_node_id(std::uint16_t style) const override {
    std::int64_t power = 1;
    for (int digit = 0; digit < std::min(18, field_width(8, columns_of(style))); ++digit) power *= 10;
    return power - 1;
  }
  std::int64_t largest_shell_id(std::uint16_t style) const override { return largest_node_id(style); }

 private:
  static std::string_view line_of(const CardRef& card) {
    return card.text.substr(card.offset, end_of_line(card.text, card.offset) - card.offset);
  }

  /// In the format of `example`: its columns or commas and its length. Unless `constrained`, its constraints become zeros.
  static WrittenCard new_card(const CardRef& card, std::int64_t id, const Vec3& at, bool constrained) {
    WrittenCard written;
    FieldLine line(line_of(card), kWrittenNodeWidths, columns_of(card.style));
    line.set(0, std::to_string(id));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t width = line.width(axis + 1);
      line.set(axis + 1, number_for(at[static_cast<Eigen::Index>(axis)], width, written));
    }
    if (!constrained)
      for (const std::size_t field : {std::size_t{4}, std::size_t{5}})
        if (!line.is_blank_or_zero(field)) line.set(field, "0");
    written.text = line.str();
    return written;
  }
};

}  // namespace

std::unique_ptr<const CardWriter> card_writer() { return std::make_unique<Writer>(); }

}  // namespace prismesh::mesh::deck::lsdyna

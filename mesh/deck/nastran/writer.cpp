#include "mesh/deck/nastran/writer.h"

#include <algorithm>
#include <cmath>

#include "base/letter_case.h"
#include "mesh/deck/nastran/card_edit.h"
#include "mesh/deck/nastran/case_set.h"
#include "mesh/deck/nastran/element_writer.h"
#include "mesh/deck/nastran/elements.h"
#include "mesh/deck/nastran/references.h"
#include "mesh/deck/nastran/replication.h"
#include "mesh/deck/nastran/weld_cards.h"
#include "mesh/deck/text/format_number.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::nastran {
namespace {

// Data fields of GRID.
constexpr std::size_t kSystem = 1;
constexpr std::size_t kCoordinates = 2;
constexpr std::size_t kOutputSystem = 5;
constexpr std::size_t kSuperelement = 7;

/// An edge that turns by less (degrees) counts as not turned.
constexpr double kTurned = 1e-9;

std::string number_for(double value, std::size_t width, WrittenCard& card) {
  std::string text = format_coordinate(value, width, Exponent::bare);
  double back = 0;
  if (!parse_real(text, back) || back != value) {
    ++card.rounded;
    card.largest_error = std::max(card.largest_error, std::abs(back - value));
  }
  return text;
}

/// The texts of a card's fields.
std::vector<std::string> fields_of(const Card& card) {
  std::vector<std::string> fields;
  for (std::size_t f = 0; f < card.size(); ++f) fields.emplace_back(card.text(f));
  return fields;
}

std::int64_t largest_id(std::uint16_t style) { return is_large(static_cast<Layout>(style)) ? 9999999999999999 : 99999999; }

/// The element of the same kind with that number of corners; empty: there is none.
std::string_view name_with(std::string_view name, int corners) {
  if (name == "CQUAD4" || name == "CTRIA3") return corners == 4 ? "CQUAD4" : "CTRIA3";
  if (name == "CQUADR" || name == "CTRIAR") return corners == 4 ? "CQUADR" : "CTRIAR";
  return {};
}

class ShellWriter {
 public:
  ShellWriter(std::string_view text, std::size_t offset, const ShellCard& shell)
      : text_(text), offset_(offset), shell_(shell), card_(card_at(text, offset)), from_(shell_fields(card_.name())) {}

  Result<WrittenCard> write() {
    const int corners = shell_.nodes[2] == shell_.nodes[3] ? 3 : 4;
    if (is_replicated(text_, offset_)) return fail("", "is made by replication or replicated");
    if (card_.misplaced()) return fail("", "has continuations that aren't in order");
    if (has_midside()) return fail("", "has mid-side nodes");
    name_ = name_with(card_.name(), corners);
    if (name_.empty()) {
      if (corners != from_.corners) return fail("", "is a " + std::string(card_.name()) + ", which has another number of corners");
      name_ = card_.name();
    }
    if (shell_.id == card_.integer_or_zero(0) && corners == from_.corners && !changes_besides_nodes()) return in_place();
    return anew();
  }

 private:
  bool has_midside() const {
    for (std::size_t i = 0; i < from_.midside; ++i)
      if (card_.integer_or_zero(2u + from_.corners + i) > 0) return true;
    return false;
  }

  bool has_thickness() const {
    for (std::size_t c = 0; c < from_.corners; ++c)
      if (from_.thickness && !card_.blank(from_.thickness + c)) return true;
    return false;
  }

  /// An integer in the angle's field names a coordinate system, which doesn't follow the edge.
  bool has_angle() const {
    const std::string_view angle = card_.text(from_.angle);
    return from_.angle && (angle.empty() || angle.find('.') != std::string_view::npos);
  }

  bool changes_besides_nodes() const {
    if (has_angle() && std::abs(shell_.turn_degrees) > kTurned) return true;
    if (!has_thickness()) return false;
    for (std::size_t i = 0; i < from_.corners; ++i)
      for (std::size_t j = 0; j < from_.corners; ++j)
        if (std::abs(shell_.share[i][j] - (i == j ? 1 : 0)) > 1e-12) return true;
    return false;
  }

  Result<WrittenCard> in_place() {
    CardEdit edit(text_, offset_);
    for (std::size_t c = 0; c < from_.corners; ++c)
      if (card_.integer_or_zero(2 + c) != shell_.nodes[c]) edit.set(2 + c, std::to_string(shell_.nodes[c]));
    return WrittenCard{edit.text()};
  }

  Result<WrittenCard> anew() {
    Manner manner = manner_of(text_, offset_);
    const ShellFields to = shell_fields(name_);
    WrittenCard written;
    std::vector<std::string> fields(18);
    fields[0] = std::to_string(shell_.id);
    fields[1] = card_.blank(1) ? std::string(card_.text(0)) : std::string(card_.text(1));
    for (std::size_t c = 0; c < to.corners; ++c) fields[2 + c] = std::to_string(shell_.nodes[c]);
    if (from_.offset && to.offset) fields[to.offset] = card_.text(from_.offset);
    if (from_.angle && to.angle) fields[to.angle] = angle_text(manner, written);
    if (has_thickness()) {
      fields[to.relative] = card_.text(from_.relative);
      for (std::size_t c = 0; c < to.corners; ++c) {
        const std::optional<double> mixed = mixed_thickness(c);
        if (!mixed) return fail("", "has a thickness of its own at some of its corners only");
        fields[to.thickness + c] = number_for(*mixed, width_of(manner.layout), written);
      }
    }
    written.text = write_card(name_, fields, manner);
    return written;
  }

  std::string angle_text(const Manner& manner, WrittenCard& written) const {
    if (!has_angle() || std::abs(shell_.turn_degrees) <= kTurned) return std::string(card_.text(from_.angle));
    double turned = std::fmod(card_.real(from_.angle).value_or(0) - shell_.turn_degrees, 360);
    if (turned > 180) turned -= 360;
    if (turned <= -180) turned += 360;
    written.turned = true;
    // The report of rounding is about coordinates; an angle's isn't part of it.
    WrittenCard rounding;
    std::string text = number_for(turned, width_of(manner.layout), rounding);
    return text;
  }

  std::optional<double> mixed_thickness(std::size_t corner) const {
    double sum = 0;
    for (std::size_t c = 0; c < from_.corners; ++c) {
      const double share = shell_.share[corner][c];
      if (share == 0) continue;
      if (card_.blank(from_.thickness + c)) return std::nullopt;
      const std::optional<double> value = card_.real(from_.thickness + c);
      if (!value) return std::nullopt;
      sum += share * *value;
    }
    return sum;
  }

  std::string_view text_;
  std::size_t offset_;
  const ShellCard& shell_;
  Card card_;
  ShellFields from_;
  std::string_view name_;
};

/// How ids are added to a card's list.
enum class Lengthening : std::uint8_t {
  never,           ///< they can't be: a field behind the last would mean something else, or the order counts
  by_cards,        ///< by another card of the same set, with continuations
  by_short_cards,  ///< the same, but the cards have no continuation
  at_end,          ///< at the end of the list, over continuations, also behind ranges
  at_plain_end,    ///< the same, but a card with a range has no other ids
};

Lengthening lengthening_of(std::string_view name) {
  struct ListCard {
    std::string_view name;
    Lengthening lengthening;
  };
  using enum Lengthening;
  static constexpr ListCard kListCards[] = {
      {"SPC1", by_cards},          {"SPCOFF1", by_cards},     {"ASET1", by_cards},       {"BSET1", by_cards},
      {"CSET1", by_cards},         {"OMIT1", by_cards},       {"QSET1", by_cards},       {"USET1", by_cards},
      {"SEBSET1", by_cards},       {"SECSET1", by_cards},     {"SEQSET1", by_cards},     {"QBDY1", by_cards},
      {"PLOAD2", by_short_cards},  {"SESET", by_short_cards}, {"SEELT", by_short_cards}, {"BNDGRID", by_short_cards},
      {"RELEASE", by_short_cards}, {"QVOL", by_short_cards},  {"SET", at_end},           {"SET3", at_end},
      {"ACCEL1", at_end},          {"SET1", at_plain_end},    {"BSURF", at_plain_end},   {"TEMPP1", at_plain_end},
      {"TEMPRB", at_plain_end},    {"SEBNDRY", at_plain_end}, {"SEEXCLD", at_plain_end}, {"ELIST", at_plain_end},
  };
  for (const ListCard& card : kListCards)
    if (card.name == name) return card.lengthening;
  return never;
}

bool has_range(const Card& card, std::size_t list) {
  for (std::size_t f = list; f < card.size(); ++f)
    if (begins_with(card.text(f), "THRU")) return true;
  return false;
}

class Writer : public CardWriter {
 public:
  std::size_t node_end(const CardRef& card) const override { return end_of_card(card.text, card.offset); }
  std::size_t shell_end(const CardRef& card) const override { return end_of_card(card.text, card.offset); }

  std::optional<Vec3> node_coordinates(const CardRef& card) const override {
    const Card fields = card_at(card.text, card.offset);
    Vec3 out;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::optional<double> value = fields.real(kCoordinates + axis);
      if (!value) return std::nullopt;
      out[static_cast<Eigen::Index>(axis)] = *value;
    }
    return out;
  }

  WrittenCard move_node(const CardRef& card, const Vec3& from, const Vec3& to) const override {
    CardEdit edit(card.text, card.offset);
    WrittenCard written;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<Eigen::Index>(axis);
      if (from[a] != to[a]) edit.set(kCoordinates + axis, number_for(to[a], edit.width(kCoordinates + axis), written));
    }
    written.text = edit.text();
    return written;
  }

  WrittenCard new_node(const CardRef& card, std::int64_t id, const Vec3& at) const override { return write_node(card, id, at, false); }

  std::string node_constraints(const CardRef& card) const override {
    const Card fields = card_at(card.text, card.offset);
    std::string out;
    for (std::size_t f = kOutputSystem; f <= kSuperelement; ++f)
      if (!fields.blank(f)) out += "," + std::to_string(f) + "=" + upper(fields.text(f));
    return out;
  }

  Result<WrittenCard> new_constrained_node(const CardRef& card, std::int64_t id, const Vec3& at) const override {
    return write_node(card, id, at, true);
  }

  Result<WrittenCard> shell(const CardRef& card, const ShellCard& shell) const override {
    return ShellWriter(card.text, card.offset, shell).write();
  }

  bool stands_alone(const CardRef& card) const override { return !is_replicated(card.text, card.offset); }

  /// A CQUAD4 becomes a CTRIA3 by its name.
  bool holds_triangles_and_quads(const CardRef& card) const override {
    return !name_with(card_at(card.text, card.offset).name(), 3).empty();
  }

  Result<std::vector<Replacement>> join(std::string_view text, const Referrer& set, std::span<const std::int64_t> ids) const override {
    if (ids.empty()) return std::vector<Replacement>{};
    if (is_replicated(text, set.offset)) return fail("", "is made by replication");
    const Card card = card_at(text, set.offset);
    if (is_case_set(card, set)) return join_case_set(text, set, ids);
    if (card.name() == "PLOAD4") return copy_pressure(text, set.offset, card, ids);
    switch (lengthening_of(card.name())) {
      case Lengthening::by_cards: return join_by_card(text, set, card, ids, ids.size());
      case Lengthening::by_short_cards: return join_by_card(text, set, card, ids, fields_on(Layout::small) - list_field(card.name()));
      case Lengthening::at_plain_end:
        if (has_range(card, list_field(card.name()))) return fail("", "names a range, which leaves no room for more ids");
        [[fallthrough]];
      case Lengthening::at_end: return join_in_card(text, set, card, ids);
      case Lengthening::never: break;
    }
    return fail("", "has a list that can't take more ids");
  }

  Result<std::vector<Replacement>> change_list(std::string_view text, const Referrer& set, std::span<const std::int64_t> joining,
                                               std::span<const std::int64_t> leaving) const override {
    if (leaving.empty()) return join(text, set, joining);
    if (is_replicated(text, set.offset)) return fail("", "is made by replication");
    // In a copy of the card and its line end: first ids are removed, then the new ones are added.
    const bool of_case = is_case_set(card_at(text, set.offset), set);
    const std::size_t last = of_case ? std::min<std::size_t>(set.end, text.size()) : end_of_card(text, set.offset);
    const std::size_t line_end = std::min(text.find('\n', last), text.size() - 1) + 1;
    std::string card_text(text.substr(set.offset, line_end - set.offset));
    Referrer card = set;
    card.offset = 0;
    card.end = last - set.offset;
    Result<std::string> left =
        of_case ? without_in_case_set(card_text.substr(0, card.end), leaving) : without_in_card(card_text, card_at(card_text, 0), leaving);
    if (!left) return fail(left.error());
    card_text.replace(0, card.end, *left);
    card.end = left->size();
    const Result<std::vector<Replacement>> more = join(card_text, card, joining);
    if (!more) return fail(more.error());
    std::size_t length = card.end;
    for (const Replacement& replacement : *more) {
      card_text.replace(replacement.offset, replacement.length, replacement.text);
      length += replacement.text.size() - replacement.length;
    }
    card_text.resize(length);
    return std::vector<Replacement>{{set.offset, last - set.offset, std::move(card_text)}};
  }

  Inheritance inheritance(const Referrer& card, Referred referred) const override {
    static constexpr std::string_view kStays[] = {
        "FORCE",  "FORCE1", "FORCE2",  "MOMENT", "MOMENT1", "MOMENT2", "RBE1",  "RBE2",   "RBE3",  "RBAR",  "RBAR1",  "RROD",
        "RJOINT", "RTRPLT", "RSPLINE", "CBAR",   "CBEAM",   "CBEND",   "CBUSH", "CGAP",   "CWELD", "CFAST", "CORD1R", "CORD1C",
        "CORD1S", "DAREA",  "SLOAD",   "DRESP1", "EIGR",    "EIGB",    "EIGC",  "PARAM",  "MPC",   "PLOAD", "ASET",   "BSET",
        "CSET",   "OMIT",   "QSET",    "SUPORT", "SUPORT1", "SEQGP",   "TIC",   "RFORCE", "DELAY", "DPHASE"};
    if (card.keyword == "SPC" && referred == Referred::node) return Inheritance::follows;
    if (card.keyword == "PLOAD4" && referred != Referred::node) return Inheritance::follows;
    if (std::find(std::begin(kStays), std::end(kStays), card.keyword) != std::end(kStays)) return Inheritance::stays;
    return Inheritance::forbids;
  }

  Result<std::vector<Replacement>> copy_single(std::string_view text, const Referrer& referrer, const Reference& single,
                                               std::span<const std::int64_t> ids) const override {
    const std::size_t offset = single.card;
    if (is_replicated(text, offset)) return fail("", "is made by replication");
    const Card card = card_at(text, offset);
    std::vector<std::string> fields = fields_of(card);
    if (referrer.keyword != "SPC") return copy_pressure(text, offset, card, ids);
    const std::size_t at = card.integer_or_zero(1) == single.first ? 1 : 4;
    fields.resize(std::max<std::size_t>(fields.size(), 8));
    fields = {fields[0], "", fields[at + 1], fields[at + 2]};
    const Manner manner = manner_of(text, offset);
    Replacement replacement{end_of_card(text, offset), 0, {}};
    for (const std::int64_t id : ids) {
      fields[1] = std::to_string(id);
      replacement.text += manner.line_end + write_card(card.name(), fields, manner);
    }
    return std::vector<Replacement>{std::move(replacement)};
  }

  Result<deck::ElementPlace> find_element(const Deck& deck, ElementClass element_class, std::int64_t id,
                                          std::span<const std::int64_t>) const override {
    return nastran::find_element(deck, element_class, id);
  }
  Result<WrittenCard> element_like(std::string_view text, const deck::ElementPlace& example, const ElementCard& element) const override {
    return weld_like(text, example.offset, element);
  }
  bool names_sheets() const override { return true; }
  ElementClass weld_class() const override { return ElementClass::discrete; }
  std::size_t end_of_cards(std::string_view text) const override { return end_of_bulk_data(text); }
  Result<std::string> element_header(ElementClass, const Part&) const override { return std::string(); }
  Result<WrittenCard> new_element(std::string_view text, ElementClass, const ElementCard& element) const override {
    return new_weld(text, element);
  }
  Result<std::pair<Part, std::string>> weld_part(const Deck& deck, const Model& model, const WeldPart& wanted) const override {
    return nastran::weld_part(deck, model, wanted);
  }

  std::int64_t largest_node_id(std::uint16_t style) const override { return largest_id(style); }
  std::int64_t largest_shell_id(std::uint16_t style) const override { return largest_id(style); }

 private:
  /// SET is a command of case control as well as an entry of bulk data.
  static bool is_case_set(const Card& card, const Referrer& set) { return set.keyword == "SET" && card.name() != "SET"; }

  /// A PLOAD4 for each of the elements, with the pressures and the direction of the one at `offset`, also where that is of a range.
  static Result<std::vector<Replacement>> copy_pressure(std::string_view text, std::size_t offset, const Card& card,
                                                        std::span<const std::int64_t> ids) {
    if (card.misplaced() || card.overlong()) return fail("", "has continuations that aren't in order");
    const bool range = begins_with(card.text(6), "THRU");
    if (!range && (!card.blank(6) || !card.blank(7))) return fail("", "says by corners on which face it acts");
    std::vector<std::string> fields = fields_of(card);
    fields.resize(std::max<std::size_t>(fields.size(), 8));
    for (std::size_t corner = 3; corner < 6; ++corner)
      if (!card.blank(corner) && card.real(corner) != card.real(2)) return fail("", "gives the corners different pressures");
    fields[6].clear();
    fields[7].clear();
    const Manner manner = manner_of(text, offset);
    Replacement replacement{end_of_card(text, offset), 0, {}};
    for (const std::int64_t id : ids) {
      fields[1] = std::to_string(id);
      replacement.text += manner.line_end + write_card(card.name(), fields, manner);
    }
    return std::vector<Replacement>{std::move(replacement)};
  }

  static WrittenCard write_node(const CardRef& example, std::int64_t id, const Vec3& at, bool constrained) {
    const Card card = card_at(example.text, example.offset);
    const Manner manner = manner_of(example.text, example.offset);
    WrittenCard written;
    std::vector<std::string> fields(8);
    fields[0] = std::to_string(id);
    fields[kSystem] = card.text(kSystem);
    for (std::size_t axis = 0; axis < 3; ++axis)
      fields[kCoordinates + axis] = number_for(at[static_cast<Eigen::Index>(axis)], width_of(manner.layout), written);
    if (constrained)
      for (std::size_t f = kOutputSystem; f <= kSuperelement; ++f) fields[f] = card.text(f);
    written.text = write_card("GRID", fields, manner);
    return written;
  }

  static Result<std::vector<Replacement>> join_by_card(std::string_view text, const Referrer& set, const Card& card,
                                                       std::span<const std::int64_t> ids, std::size_t at_once) {
    const std::size_t list = list_field(card.name());
    const Manner manner = manner_of(text, set.offset);
    Replacement replacement{end_of_card(text, set.offset), 0, {}};
    for (std::size_t i = 0; i < ids.size(); i += at_once) {
      std::vector<std::string> fields;
      for (std::size_t f = 0; f < list; ++f) fields.emplace_back(card.text(f));
      for (std::size_t k = i; k < std::min(i + at_once, ids.size()); ++k) fields.push_back(std::to_string(ids[k]));
      replacement.text += manner.line_end + write_card(card.name(), fields, manner);
    }
    return std::vector<Replacement>{std::move(replacement)};
  }

  static Result<std::vector<Replacement>> join_in_card(std::string_view text, const Referrer& set, const Card& card,
                                                       std::span<const std::int64_t> ids) {
    if (card.misplaced() || card.overlong()) return fail("", "has lines that can't be continued");
    std::size_t field = card.size();
    while (field > 0 && card.blank(field - 1)) --field;
    for (std::size_t f = 0; f < field; ++f)
      if (upper(card.text(f)) == "EXCEPT") return fail("", "ends with what it leaves out");
    if (card.name() == "SET" && !card.blank(2) && upper(card.text(2)) != "LIST") return fail("", "doesn't list its ids");
    field = std::max(field, list_field(card.name()));
    CardEdit edit(text, set.offset);
    for (const std::int64_t id : ids) edit.set(field++, std::to_string(id));
    return std::vector<Replacement>{{set.offset, end_of_card(text, set.offset) - set.offset, edit.text()}};
  }

  /// The text of a card without ids that its list names singly.
  static Result<std::string> without_in_card(std::string_view text, const Card& card, std::span<const std::int64_t> leaving) {
    if (lengthening_of(card.name()) == Lengthening::never) return fail("", "has a list that ids can't be taken out of");
    if (card.misplaced() || card.overlong()) return fail("", "has continuations that aren't in order");
    const std::size_t list = list_field(card.name());
    if (has_range(card, list)) return fail("", "has ranges beside the ids that would have to be taken out");
    std::vector<std::string> kept;
    for (std::size_t f = list; f < card.size(); ++f)
      if (!card.blank(f) && std::find(leaving.begin(), leaving.end(), card.integer_or_zero(f)) == leaving.end())
        kept.emplace_back(card.text(f));
    if (kept.empty()) return fail("", "would name nothing any more");
    CardEdit edit(text, 0);
    for (std::size_t f = list; f < card.size(); ++f)
      if (f - list < kept.size() || !card.blank(f)) edit.set(f, f - list < kept.size() ? kept[f - list] : std::string());
    edit.drop_lines_from(list + kept.size());
    return edit.text();
  }
};

}  // namespace

std::unique_ptr<const CardWriter> card_writer() { return std::make_unique<Writer>(); }

}  // namespace prismesh::mesh::deck::nastran

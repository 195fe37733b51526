#include "mesh/deck/lsdyna/contact_cards.h"

#include <cmath>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "mesh/deck/lsdyna/block_lines.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::lsdyna {
namespace {

bool has_any(std::string_view keyword, std::initializer_list<std::string_view> words) {
  for (const std::string_view word : words)
    if (has_word(keyword, word)) return true;
  return false;
}

/// The forms that have other cards, or keep nothing apart.
bool is_other_form(std::string_view keyword) {
  return has_any(keyword, {"2D", "ENTITY", "GEBOD", "RIGID_SURFACE", "COUPLING", "AUTO_MOVE", "DRAWBEAD", "ADD_WEAR", "EXCLUDE_INTERACTION",
                           "GUIDED_CABLE", "WEAR", "FORCE_TRANSDUCER", "INTERIOR", "BEAMS"});
}

double positive(std::optional<double> value) { return value && std::isfinite(*value) && *value > 0 ? *value : 0; }

/// A side by its number and the kind of that number: the values of SURFATYP and SURFBTYP.
ContactSide side_of(std::int64_t id, std::int64_t kind, const IdOffsets& offsets) {
  ContactSide side;
  const auto named = [&](Referred referred, std::int64_t offset) {
    if (id <= 0) return;
    side.referred = referred;
    side.id = id + offset;
  };
  switch (kind) {
    case 0: named(Referred::segment_set, offsets.set); break;
    case 1: named(Referred::shell_set, offsets.set); break;
    case 2: named(Referred::part_set, offsets.set); break;
    case 3: named(Referred::part, offsets.part); break;
    case 4: named(Referred::node_set, offsets.set); break;
    case 5: side.everything = true; break;
    case 6:
      named(Referred::part_set, offsets.set);
      side.all_but = true;
      break;
    default: break;
  }
  return side;
}

/// The cards of a contact, from its title on.
std::vector<std::string_view> lines_of(std::string_view text, const Block& block) {
  const std::vector<EncryptedPart> none;
  BlockLines lines(text, block.begin, block.end, none);
  std::vector<std::string_view> all;
  Line line;
  while (all.size() < 16 && lines.next(line)) {
    if (line.text.starts_with(kEncryptedBegin)) break;
    all.push_back(line.text);
  }
  return all;
}

}  // namespace

bool ContactReader::read(std::string_view text, const Block& block, const Parameters& parameters, const IncludeContext& context) {
  if (block.name == "CONTROL_CONTACT") {
    read_control(text, block, parameters, context);
    return true;
  }
  if (block.name == "CONTROL_SHELL") {
    read_shell_control(text, block, parameters);
    return true;
  }
  if (!block.name.starts_with("CONTACT_")) return false;
  if (!is_other_form(block.name)) read_contact(text, block, parameters, context);
  return true;
}

void ContactReader::read_contact(std::string_view text, const Block& block, const Parameters& parameters, const IncludeContext& context) {
  const std::string_view keyword = block.name;
  const std::vector<std::string_view> lines = lines_of(text, block);
  Read read;
  ContactCard& contact = read.card;
  contact.keyword = keyword;
  std::size_t at = 0;
  const auto next = [&](Card& card) {
    if (at >= lines.size()) return false;
    card.cut(lines[at++], block.columns);
    return true;
  };
  Card card;
  if (has_any(keyword, {"ID", "TITLE"})) {
    if (!next(card)) return;
    if (const std::int64_t id = card.integer(0, parameters).value_or(0); id > 0) contact.id = id + context.offsets.other;
    const std::string_view line = lines[at - 1];
    const std::size_t comma = line.find(',');
    const std::size_t width = block.columns == Columns::wide ? kWideColumns : 10;
    const std::size_t title = comma != std::string_view::npos ? comma + 1 : width;
    if (title < line.size()) contact.title = trim(line.substr(title));
  }
  if (has_word(keyword, "MPP")) {
    if (!next(card)) return;
    if (at < lines.size() && lines[at].starts_with('&')) ++at;
  }
  Card sides, friction, thicknesses;
  if (!next(sides) || !next(friction) || !next(thicknesses)) return;
  const auto whole = [&](const Card& of, std::size_t field) { return of.integer(field, parameters).value_or(0); };
  const bool single = has_any(keyword, {"SINGLE_SURFACE", "AUTOMATIC_GENERAL"});
  contact.a = side_of(whole(sides, 0), whole(sides, 2), context.offsets);
  if (single && whole(sides, 0) <= 0) contact.a.everything = true;
  if (!single) contact.b = side_of(whole(sides, 1), whole(sides, 3), context.offsets);
  contact.a.thickness = positive(thicknesses.real(2, parameters)) * context.length;
  contact.a.scale = positive(thicknesses.real(4, parameters));
  if (contact.b) {
    contact.b->thickness = positive(thicknesses.real(3, parameters)) * context.length;
    contact.b->scale = positive(thicknesses.real(5, parameters));
  }
  contact.ties = has_any(keyword, {"TIED", "SPOTWELD"});
  contact.limited_by_sides = single;
  read.has_own_thickness_rule = single || has_any(keyword, {"AUTOMATIC", "FORMING"});
  // Optional cards A and B follow, where no card of the type's own is between.
  if (!read.has_own_thickness_rule &&
      !has_any(keyword, {"ERODING", "CONSTRAINT", "INTERFERENCE", "TIEBREAK", "TIED", "THERMAL", "FRICTION"})) {
    Card soft, thickness;
    if (next(soft) && next(thickness)) read.thickness_considered = whole(thickness, 2);
  }
  read_.push_back(std::move(read));
}

void ContactReader::read_control(std::string_view text, const Block& block, const Parameters& parameters, const IncludeContext& context) {
  const std::vector<std::string_view> lines = lines_of(text, block);
  Card card;
  if (lines.empty()) return;
  card.cut(lines[0], block.columns);
  thickness_considered_ = card.integer(3, parameters).value_or(0);
  if (lines.size() < 2) return;
  card.cut(lines[1], block.columns);
  actual_thickness_ = card.integer(5, parameters).value_or(0);
  if (lines.size() < 3) return;
  card.cut(lines[2], block.columns);
  thickness_ = positive(card.real(4, parameters)) * context.length;
}

/// Optional card 2 has CNTCO third; the card before it is needed for it.
void ContactReader::read_shell_control(std::string_view text, const Block& block, const Parameters& parameters) {
  const std::vector<std::string_view> lines = lines_of(text, block);
  if (lines.size() < 3) return;
  Card card;
  card.cut(lines[2], block.columns);
  offsets_ = card.integer(2, parameters).value_or(0);
}

/// NLOC: 1 is the top of the shell, -1 its bottom; the middle lies half a thickness from there.
void ContactReader::read_section(std::int64_t section, const Card& card, const Parameters& parameters) {
  const std::optional<double> location = card.real(4, parameters);
  if (location && std::isfinite(*location) && *location != 0) offset_of_section_.try_emplace(section, -0.5 * *location);
}

void ContactReader::read_part(std::int64_t part, const Card& card, const Parameters& parameters, const IncludeContext& context) {
  const PartContact contact{positive(card.real(4, parameters)) * context.length, positive(card.real(5, parameters))};
  if (contact.thickness > 0 || contact.scale > 0) of_part_.try_emplace(part, contact);
}

ContactCards ContactReader::cards() const {
  ContactCards cards;
  cards.of_part = of_part_;
  cards.thickness = thickness_;
  if (offsets_ == 1) cards.offsets = ContactOffsets::of_shell;
  if (offsets_ == 2) cards.offsets = ContactOffsets::of_contact;
  cards.offset_of_section = offset_of_section_;
  for (const Read& read : read_) {
    ContactCard card = read.card;
    const std::int64_t considered = read.thickness_considered != 0 ? read.thickness_considered : thickness_considered_;
    card.thick = read.has_own_thickness_rule || considered != 0;
    card.limited_by_sides = card.limited_by_sides && actual_thickness_ == 0;
    cards.cards.push_back(std::move(card));
  }
  return cards;
}

}  // namespace prismesh::mesh::deck::lsdyna

#include "mesh/deck/lsdyna/card_references.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/letter_case.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::lsdyna {
namespace {

/// An entity of a block: its header, and its lines so far, whose fields may say which further cards there are.
struct Entity {
  Line header;
  bool has_header = false;  ///< one that has no referrer yet
  bool header_has_id = false;
  std::vector<std::string_view> lines;  ///< by card; of a repeated card the last
  Card card;                            ///< the last line, cut
};

/// The number in a field of one of the entity's cards; both from 1. 0: there is none.
std::int64_t value_of(const Entity& entity, std::uint8_t card, std::uint8_t field, const ReferenceBlock& block) {
  if (card == 0 || card > entity.lines.size() || field == 0) return 0;
  Card other;
  other.cut(entity.lines[card - 1u], block.widths, block.columns);
  const std::optional<double> value = other.real(field - 1u, block.parameters);
  return value && std::abs(*value) < 1e18 ? static_cast<std::int64_t>(*value) : 0;
}

bool is_there(const CardRule& rule, const Entity& entity, const ReferenceBlock& block) {
  if (rule.condition_card == 0) return true;
  const std::int64_t value = value_of(entity, rule.condition_card, rule.condition_field, block);
  const auto& values = rule.condition_values;
  return (std::find(values.begin(), values.end(), value) != values.end()) != rule.unless;
}

/// The title of a header, and its id where it has one and `id` is 0.
std::string_view read_header(const Entity& entity, const ReferenceBlock& block, std::int64_t& id) {
  const std::string_view text = entity.header.text;
  if (!entity.header_has_id) return trim(text);
  Card header;
  header.cut(text, block.columns);
  if (id == 0) id = header.integer(0, block.parameters).value_or(0);
  const std::size_t width = block.columns == Columns::wide ? kWideColumns : 10;
  const std::size_t comma = text.find(',');
  return trim(text.substr(std::min(comma != std::string_view::npos ? comma + 1 : width, text.size())));
}

/// Cards with an id or a title of their own have a referrer of their own.
void begin_entity(const CardRule& rule, const Line& line, Entity& entity, ReferenceCollector& out) {
  std::int64_t id = 0;
  std::optional<Referred> defines;
  for (const FieldRule& field : rule.fields) {
    if (field.kind != FieldRule::Kind::own_id && field.kind != FieldRule::Kind::own_part) continue;
    id = out.number(entity.card, field.field);
    if (field.kind != FieldRule::Kind::own_part || id <= 0) continue;
    defines = Referred::part;
    id = out.with_offset(Referred::part, id);
  }
  if (id == 0 && !entity.has_header) return;
  const std::string_view title = read_header(entity, out.block(), id);
  out.begin_referrer({entity.has_header ? entity.header.offset : line.offset, id, title, defines});
  entity.has_header = false;
}

/// A field that says what another names: its digit, 'T' for a word with "SET", else a word's first letter; '?': something else.
char type_key(const Card& card, std::size_t field, const Parameters& parameters) {
  const std::string_view text = card.text(field);
  if (text.empty()) return '0';
  const std::optional<std::int64_t> value = card.integer(field, parameters);
  if (value) return *value >= 0 && *value <= 9 ? static_cast<char>('0' + *value) : '?';
  const std::string word = upper(text);
  return word.find("SET") != std::string::npos ? 'T' : word.front();
}

void read_typed(const FieldRule& field, const Line& line, const Entity& entity, ReferenceCollector& out) {
  const std::int64_t id = out.number(entity.card, field.field);
  if (id == 0) return;
  const ReferenceBlock& block = out.block();
  Card other;
  if (field.type_card > 0 && field.type_card <= entity.lines.size())
    other.cut(entity.lines[field.type_card - 1u], block.widths, block.columns);
  const char key = type_key(field.type_card > 0 ? other : entity.card, field.type_field - 1u, block.parameters);
  std::size_t at = 0;
  while (at + 1 < field.types.size() && field.types[at] != key && field.types[at] != '_') at += 2;
  Referred referred = Referred::node;
  if (at + 1 >= field.types.size())
    out.set_unclear();
  else if (referred_of(field.types[at + 1], referred))
    out.add(referred, ReferenceRole::single, id, line.offset);
}

void read_field(const FieldRule& field, const Line& line, const Entity& entity, ReferenceCollector& out) {
  switch (field.kind) {
    case FieldRule::Kind::own_id:
    case FieldRule::Kind::own_part: return;
    case FieldRule::Kind::range: {
      const std::int64_t first = out.number(entity.card, field.field), last = out.number(entity.card, field.field + 1u);
      const ReferenceRole role = last == 0 ? ReferenceRole::single : ReferenceRole::range;
      return out.add({field.referred, role, first, last == 0 ? first : last}, line.offset);
    }
    case FieldRule::Kind::typed: return read_typed(field, line, entity, out);
    case FieldRule::Kind::id: break;
  }
  const std::int64_t id = out.number(entity.card, field.field);
  out.add(id < 0 && field.has_negative ? field.negative : field.referred, ReferenceRole::single, id, line.offset);
}

/// False: the block is at its end.
bool read_card(BlockLines& lines, const std::vector<CardRule>& cards, std::size_t c, Entity& entity, ReferenceCollector& out) {
  Line line;
  if (!lines.next(line)) return false;
  entity.lines.resize(std::max(entity.lines.size(), c + 1));
  entity.lines[c] = line.text;
  if (cards[c].fields.empty()) return true;
  out.cut(line, entity.card);
  begin_entity(cards[c], line, entity, out);
  for (const FieldRule& field : cards[c].fields) read_field(field, line, entity, out);
  return true;
}

/// Cards from `first` on, all of them `times` times. False: the block is at its end.
bool read_group(BlockLines& lines, const std::vector<CardRule>& cards, std::size_t first, Entity& entity, ReferenceCollector& out) {
  const std::int64_t times = value_of(entity, cards[first].count_card, cards[first].count_field, out.block());
  for (std::int64_t i = 0; i < times; ++i)
    for (std::size_t c = first; c < cards.size(); ++c)
      if (!read_card(lines, cards, c, entity, out)) return false;
  return true;
}

/// One round through the cards. False: the block is at its end.
bool read_entity(BlockLines& lines, const std::vector<CardRule>& cards, Entity& entity, ReferenceCollector& out) {
  for (std::size_t c = 0; c < cards.size(); ++c) {
    const CardRule& rule = cards[c];
    entity.lines.resize(std::max(entity.lines.size(), c));
    if (!is_there(rule, entity, out.block())) continue;
    if (rule.repeat == CardRule::Repeat::group) return read_group(lines, cards, c, entity, out);
    std::int64_t times = 1;
    if (rule.repeat == CardRule::Repeat::to_the_end) times = kEveryId;
    if (rule.repeat == CardRule::Repeat::count) times = value_of(entity, rule.count_card, rule.count_field, out.block());
    for (std::int64_t i = 0; i < times; ++i)
      if (!read_card(lines, cards, c, entity, out)) return false;
  }
  return true;
}

/// The first of the header's lines counts. False: the block is at its end.
bool read_header_lines(BlockLines& lines, int count, Entity& entity) {
  Line line;
  for (int i = 0; i < count; ++i) {
    if (!lines.next(line)) return false;
    if (i == 0) entity.header = line;
  }
  return true;
}

}  // namespace

bool read_card_references(BlockLines& lines, const ReferenceRule& rule, std::string_view options, ReferenceCollector& out) {
  std::vector<CardRule> cards;
  int headers = 0;
  if (!compile(rule, options, cards, headers)) return false;
  if (rule.kind != RuleKind::cards) return true;
  Entity entity;
  entity.header_has_id = has_word(options, "ID");
  do {
    entity.lines.clear();
    entity.header = {};
    if (!read_header_lines(lines, headers, entity)) return true;
    entity.has_header = headers > 0;
    if (entity.has_header) out.end_referrer();
    if (!read_entity(lines, cards, entity, out)) return true;
  } while (!rule.once);
  return true;
}

bool read_contact_references(BlockLines& lines, ReferenceCollector& out) {
  const std::string_view keyword = out.block().keyword;
  for (const std::string_view other : {"2D", "ENTITY", "GEBOD", "RIGID_SURFACE", "COUPLING", "AUTO_MOVE", "DRAWBEAD", "ADD_WEAR",
                                       "EXCLUDE_INTERACTION", "GUIDED_CABLE", "WEAR"})
    if (has_word(keyword, other)) return false;
  static const ReferenceRule kSurfaces{"", RuleKind::cards, "@3:0G1S2P3p4N5z6P7z @4:0G1S2P3p4N5z6P7z"};
  std::vector<CardRule> cards;
  int headers = 0;
  compile(kSurfaces, {}, cards, headers);
  Entity entity;
  Line line;
  if (has_word(keyword, "ID") || has_word(keyword, "TITLE")) {
    if (!lines.next(entity.header)) return true;
    entity.has_header = true;
    entity.header_has_id = true;
  }
  if (has_word(keyword, "MPP")) {
    if (!lines.next(line)) return true;
    const BlockLines before = lines;
    if (lines.next(line) && (line.text.empty() || line.text.front() != '&')) lines = before;
  }
  read_card(lines, cards, 0, entity, out);
  return true;
}

}  // namespace prismesh::mesh::deck::lsdyna

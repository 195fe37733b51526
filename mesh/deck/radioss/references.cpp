#include "mesh/deck/radioss/references.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>
#include <utility>

#include "mesh/deck/radioss/naming_rules.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::radioss {
namespace {

constexpr std::size_t kMaxFieldsOnALine = 10;
/// Places of cards beyond this one can't be told apart (NamingPlace::card).
constexpr int kMaxCard = 255;

/// A block whose references are read.
struct NamingBlock {
  const Block& block;
  const NamingRule& rule;
  const DeckTables& tables;
  std::size_t width = kField;  ///< of a field
  std::int64_t added = 0;      ///< to the ids that the cards give
  std::uint32_t referrer = 0;
};

std::int64_t added_to(Referred referred, const IdOffsets& added) {
  if (referred == Referred::node || referred == Referred::sph) return added.node;
  if (is_set(referred)) return added.set;
  return referred == Referred::part ? added.part : added.element;
}

/// The id in a field, from 1. 0: blank, a word or an unknown parameter.
std::int64_t id_in(const NamingBlock& of, const Line& line, std::size_t from_one) {
  return of.tables.parameters.integer(field(line.text, of.width, from_one - 1), of.tables.contexts, of.block.context).value_or(0);
}

/// A negative id takes its entity out of the set.
void add_one(const NamingBlock& of, const Line& line, std::int64_t id, ReferenceRole role, References& out) {
  if (id == 0) return;
  const std::int64_t named = std::abs(id) + of.added;
  out.add(Reference{of.rule.referred, id < 0 ? ReferenceRole::single : role, named, named, 1, of.referrer, line.offset, id < 0});
}

/// The range whose first id is in field `f`, with its step if it has one in the field behind the last.
void add_id_range(const NamingBlock& of, const Line& line, std::size_t f, bool has_step, References& out) {
  const std::int64_t first = id_in(of, line, f), last = id_in(of, line, f + 1);
  const std::int64_t step = has_step ? id_in(of, line, f + 2) : 1;
  if (first <= 0 && last <= 0) return;
  out.add(Reference{of.rule.referred, ReferenceRole::range, first + of.added, last + of.added, std::max<std::int64_t>(step, 1), of.referrer,
                    line.offset});
}

void add_place(const NamingBlock& of, const Line& line, int card, const NamingPlace& place, References& out) {
  if (place.card == 0 || (place.onwards ? card < place.card : card != place.card)) return;
  const ReferenceRole role = of.rule.naming == Naming::segments ? ReferenceRole::segment : ReferenceRole::single;
  for (std::size_t f = place.field; f < std::size_t{place.field} + place.fields; ++f) add_one(of, line, id_in(of, line, f), role, out);
}

void read_naming_card(const NamingBlock& of, const Line& line, int card, References& out) {
  const std::size_t fields = std::min((line.text.size() + of.width - 1) / of.width, kMaxFieldsOnALine);
  switch (of.rule.naming) {
    case Naming::list:
      for (std::size_t f = 1; f <= fields; ++f) add_one(of, line, id_in(of, line, f), ReferenceRole::list, out);
      break;
    case Naming::range:
      for (std::size_t f = 1; f + 1 <= fields; f += 2) add_id_range(of, line, f, false, out);
      break;
    case Naming::step:
      for (std::size_t f = 1; f + 1 <= fields; f += 3) add_id_range(of, line, f, true, out);
      break;
    case Naming::segments: add_place(of, line, card, of.rule.first, out); break;
    case Naming::places:
      add_place(of, line, card, of.rule.first, out);
      add_place(of, line, card, of.rule.second, out);
      break;
    case Naming::nothing:
    case Naming::unknown: break;
  }
}

ShellKind shells_named_by(const Keyword& keyword) {
  const std::string_view word = keyword.word(keyword.word(0) == "TH" ? 1 : 0);
  if (word == "GRSH3N" || word == "SH3N") return ShellKind::triangles;
  return word == "GRSHEL" || word == "SHEL" || word == "SHELL" ? ShellKind::quads : ShellKind::any;
}

/// The block as a referrer; its first line is the title.
Referrer referrer_of(const Block& block, const Keyword& keyword, const Context& context, std::string_view title) {
  Referrer referrer;
  referrer.keyword = keyword.joined();
  referrer.id = keyword.number(keyword.word(0) == "ADMAS" ? 1 : 0);
  referrer.id += referrer.id > 0 ? context.added.set : 0;
  referrer.title = std::string(title);
  referrer.file = block.file;
  referrer.offset = block.offset;
  referrer.end = block.body.end;
  referrer.shells = shells_named_by(keyword);
  referrer.style = referrer_style(context.field_width() == kOldField, context.added);
  return referrer;
}

void add_unknown(const Block& block, const Keyword& keyword, References& out) {
  out.add(UnreadText{keyword.joined(), block.file, block.offset, block.body.end, false});
  for (const Stretch& stretch : block.more) out.add(UnreadText{keyword.joined(), stretch.file, stretch.begin, stretch.end, false});
}

}  // namespace

std::uint16_t referrer_style(bool old, const IdOffsets& added) {
  return static_cast<std::uint16_t>((old ? 1 : 0) | (added == IdOffsets() ? 0 : 2));
}
bool is_old(std::uint16_t referrer_style) { return (referrer_style & 1) != 0; }
bool adds_to_ids(std::uint16_t referrer_style) { return (referrer_style & 2) != 0; }

void read_references(const Block& block, const Keyword& keyword, const DeckTables& tables, References& references) {
  const NamingRule rule = naming_rule(keyword);
  if (rule.naming == Naming::nothing) return;
  if (rule.naming == Naming::unknown) return add_unknown(block, keyword, references);
  const Context& context = tables.contexts[block.context];
  BlockLines lines(tables.files, block);
  Line line;
  if (!lines.next(line)) return;
  const std::uint32_t referrer = references.add(referrer_of(block, keyword, context, trim(line.text)));
  const NamingBlock of{block, rule, tables, context.field_width(), added_to(rule.referred, context.added), referrer};
  for (int card = 1; lines.next(line); card = std::min(card + 1, kMaxCard)) read_naming_card(of, line, card, references);
}

}  // namespace prismesh::mesh::deck::radioss

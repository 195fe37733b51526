#include "mesh/deck/nastran/piece.h"

#include <algorithm>
#include <optional>
#include <string>

#include "mesh/deck/nastran/fast_lines.h"
#include "mesh/deck/nastran/mesh_entries.h"
#include "mesh/deck/nastran/replication.h"

namespace prismesh::mesh::deck::nastran {
namespace {

// --- cards that are neither grid points nor elements ---

/// SPOINT and EPOINT: ids, and ranges with THRU.
void read_scalar_points(const Card& card, std::vector<IdRange>& points) {
  for (std::size_t f = 0; f < card.size(); ++f) {
    const std::int64_t id = card.integer_or_zero(f);
    if (id <= 0) continue;
    const bool range = begins_with(card.text(f + 1), "THRU");
    points.push_back({id, range ? card.integer_or_zero(f + 2) : id});
    if (range) f += 2;
  }
}

/// CELAS3, CELAS4 and their like name scalar points, which then need no card of their own. The 4 kinds may have two elements on a card.
void read_unlisted_points(const Card& card, std::vector<IdRange>& points) {
  for (const std::size_t f : {2, 3, 6, 7})
    if (const std::int64_t id = card.integer_or_zero(f); id > 0) points.push_back({id, id});
}

/// CAERO1 to CAERO5 and ZAERO's CAERO7 and BODY7; other cards are passed over.
void read_panel(const Card& card, std::vector<AeroPanel>& panels) {
  const std::string_view name = card.name();
  AeroPanel panel{card.integer_or_zero(0), card.integer_or_zero(3), 1, 0, 0};
  if (name == "CAERO1" || name == "CAERO2" || name == "CAERO7" || name == "BODY7") {
    panel.chords = card.integer_or_zero(4);
    panel.span_list = card.integer_or_zero(5);
    panel.chord_list = card.integer_or_zero(6);
  } else if (name == "CAERO3") {
    panel = {panel.id, 0, 0, card.integer_or_zero(3), card.integer_or_zero(4)};
  } else if (name == "CAERO4" || name == "CAERO5") {
    panel.span_list = card.integer_or_zero(4);
  } else {
    return;
  }
  if (panel.id > 0) panels.push_back(panel);
}

/// Coordinate systems. False: the card is none.
bool read_system_card(const EntryCard& card, PieceTarget& target) {
  std::vector<SystemCard>& systems = target.facts.systems;
  const std::size_t known = systems.size();
  bool bad_number = false;
  if (!read_systems(card.fields, card.place.offset, systems, bad_number)) return false;
  for (std::size_t s = known; s < systems.size(); ++s) systems[s].file = card.place.file;
  if (bad_number)
    target.facts.note("bad-coordinate-system", card.place.offset, "a coordinate system has something that is no number; it is left out");
  target.references.read(card.fields, card.place);
  return true;
}

void count_old_element(std::string_view name, std::size_t offset, PieceFacts& facts) {
  auto at = facts.old_elements.find(name);
  if (at == facts.old_elements.end()) at = facts.old_elements.try_emplace(std::string(name), offset, 0).first;
  ++at->second.second;
}

bool has_number(const Card& card) {
  for (std::size_t f = 0; f < std::min<std::size_t>(card.size(), 8); ++f)
    if (!card.blank(f) && card.real(f)) return true;
  return false;
}

/// False: nothing is known of the entry.
bool read_other(const EntryCard& card, PieceTarget& target) {
  const std::string_view name = card.fields.name();
  const std::size_t offset = card.place.offset;
  PieceFacts& facts = target.facts;
  if (const std::optional<std::string> bad = unread_number(card.fields))
    facts.note("bad-card", offset, *bad + "; the card is kept as it is, without that value");
  if (facts.definitions.read(card.fields, offset) || read_system_card(card, target)) return true;
  if (name == "GRDSET") {
    const std::int64_t system = card.fields.integer_or_zero(1);
    facts.grid_default.emplace_back(offset, system < 0 || system > kMaxSystem ? 0 : system);
  } else if (name == "SPOINT" || name == "EPOINT") {
    read_scalar_points(card.fields, facts.scalar_points);
  } else if (name == "AEFACT") {
    std::int64_t factors = 0;
    for (std::size_t f = 1; f < card.fields.size(); ++f) factors += card.fields.blank(f) ? 0 : 1;
    facts.factor_lists.emplace_back(card.fields.integer_or_zero(0), factors);
  } else if (is_old_element(name)) {
    count_old_element(name, offset, facts);
  } else if (is_unread_element(name)) {
    facts.note("unread-elements", offset, std::string(name) + " elements aren't shown in this version; they are kept as they are");
    target.references.read_unread(name, card.place);
  } else if (!target.references.read(card.fields, card.place)) {
    target.references.read_unread(name, card.place);
    return false;
  }
  return true;
}

/// False: nothing is known of the entry.
bool read_entry(const EntryCard& card, PieceTarget& target) {
  const std::string_view name = card.fields.name();
  if (name == "GRID") {
    read_grid(card, target);
    return true;
  }
  read_panel(card.fields, target.facts.panels);
  if (const ElementForm* form = element_form(name)) {
    if (form->fields == NodeFields::scalar_points) read_unlisted_points(card.fields, target.facts.unlisted_points);
    read_element(card, *form, target);
    return true;
  }
  if (card.fields.misplaced())
    target.facts.note("continuation-order", *card.fields.misplaced(),
                      "a continuation of the " + std::string(name) +
                          " card has another name than the line before asks for; it is taken to belong there all the same");
  if (card.is_too_long) note_too_long(card, name, target.facts);
  return read_other(card, target);
}

// --- lines ---

/// Reads cards that need to be cut into fields, and replications of them.
class FieldReader {
 public:
  FieldReader(std::string_view text, std::uint32_t file, PieceTarget& target) : text_(text), file_(file), target_(target) {}

  /// A card that was read elsewhere: the next may take fields from it.
  void passed(const Line& line) { before_ = line.offset; }

  /// Reads what begins with this line. Returns where the line after it begins.
  std::size_t read(const Line& line) {
    switch (kind_of(line.text)) {
      case LineKind::comment: target_.facts.definitions.read_comment(line.text); return line.next;
      case LineKind::continuation:
        target_.facts.note("stray-continuation", line.offset, "a continuation follows no card; it is kept but means nothing");
        return line.next;
      case LineKind::replication: read_replication(line); return lines_.next;
      case LineKind::card: read_card(line); return lines_.next;
    }
    return line.next;
  }

 private:
  EntryCard cut(const Line& line, bool is_replicated) {
    lines_.read(text_, line.offset);
    card_.cut(lines_);
    return {card_, {file_, line.offset, lines_.end}, lines_.cut_off || card_.overlong(), is_replicated};
  }

  /// Completes a card that takes fields from the card before. Neither can be moved then.
  bool fill(const Line& line) {
    if (before_ == kNoCard) return false;
    if (source_at_ != before_) {
      CardLines lines;
      lines.read(text_, before_);
      Card source;
      source.cut(lines);
      source_.set_template(source);
    }
    if (!source_.fill(card_)) return false;
    source_.set_template(card_);
    source_at_ = line.offset;
    PieceCards& cards = target_.cards;
    if (!cards.node_offset.empty() && cards.node_offset.back() == before_)
      cards.holds.emplace_back(static_cast<std::uint32_t>(cards.node_id.size() - 1), kHeldByMaking);
    return true;
  }

  void read_card(const Line& line) {
    EntryCard card = cut(line, false);
    const bool is_filled = takes_fields(card_) && fill(line);
    before_ = line.offset;
    // A card that is replicated counts as made: moving it would move its copies.
    const bool is_template = lines_.next < text_.size() && text_[lines_.next] == '=';
    card.is_replicated = is_template || is_filled;
    if (is_template)
      replication_.set_template(card_);
    else
      replication_.clear();
    const bool is_known = read_entry(card, target_);
    PieceFacts& facts = target_.facts;
    facts.has_cards = true;
    if (is_known && !facts.has_known_cards) facts.has_known_cards = has_number(card_);
  }

  void read_replication(const Line& line) {
    EntryCard card = cut(line, true);
    const std::size_t copies = replication_.has_template() ? replication_.read(card_) : 0;
    copies_made_ += copies;
    if (copies == 0) {
      target_.facts.note("unread-replication", line.offset, "a replication follows no card or isn't understood; what it makes isn't shown");
      replication_.clear();
      return;
    }
    if (copies_made_ > Replication::kMaxCopies)
      return fail_at(target_.cards, line.offset,
                     "the replications up to here make more than " + std::to_string(Replication::kMaxCopies) + " cards");
    for (std::size_t c = 0; c < copies && !target_.cards.error; ++c) {
      replication_.make(card_);
      card.is_too_long = lines_.cut_off || card_.overlong();
      read_entry(card, target_);
    }
    source_.set_template(card_);
    before_ = source_at_ = line.offset;
  }

  std::string_view text_;
  std::uint32_t file_ = 0;
  PieceTarget& target_;
  CardLines lines_;
  Card card_;
  Replication replication_;
  std::size_t copies_made_ = 0;
  static constexpr std::size_t kNoCard = std::string_view::npos;
  std::size_t before_ = kNoCard;  ///< where the last card begins
  Replication source_;            ///< the card at `source_at_`, whose fields the next may take
  std::size_t source_at_ = kNoCard;
};

}  // namespace

PieceContent read_piece(std::string_view text, const Piece& piece) {
  text = text.substr(0, piece.end);
  PieceContent content;
  content.cards.file = piece.file;
  PieceEntities entities(content.cards);
  ReferenceReader references;
  PieceTarget target{content.cards, content.facts, entities, references};
  FieldReader field_reader(text, piece.file, target);
  FastShellCounts fast_shells;
  for (std::size_t at = piece.begin; at < text.size() && !content.cards.error;) {
    const Line line = line_at(text, at);
    const std::size_t next = read_fast(text, line, entities, fast_shells);
    if (next != 0) field_reader.passed(line);
    at = next != 0 ? next : field_reader.read(line);
  }
  content.facts.references = references.finish();
  content.facts.has_known_cards |= !content.cards.node_id.empty() || !content.cards.shells.id.empty();
  content.cards.counts.quad += fast_shells.quads;
  content.cards.counts.tri += fast_shells.trias;
  if (fast_shells.quads > 0) content.cards.count_kind("CQUAD4", fast_shells.quads);
  if (fast_shells.trias > 0) content.cards.count_kind("CTRIA3", fast_shells.trias);
  return content;
}

}  // namespace prismesh::mesh::deck::nastran

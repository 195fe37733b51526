#include "mesh/deck/radioss/contact_cards.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string_view>

#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::radioss {
namespace {

constexpr std::size_t kMaxFieldsOfALine = 10;
constexpr int kMaxDepth = 64;       ///< of groups in groups
constexpr double kMeshShare = 0.4;  ///< %mesh_size where it is 0

bool is_group(std::string_view word) {
  return word == "GRNOD" || word == "SURF" || word == "GRSHEL" || word == "GRSH3N" || word == "GRPART";
}

/// The lines of a block after its title.
class ContactLines {
 public:
  ContactLines(const Block& block, const DeckTables& tables)
      : tables_(tables), block_(block), lines_(tables.files, block), width_(tables.contexts[block.context].field_width()) {
    if (lines_.next(line_)) title_ = std::string(trim(line_.text));
  }
  const std::string& title() const { return title_; }
  bool next() { return lines_.next(line_); }
  std::size_t fields() const { return std::min((line_.text.size() + width_ - 1) / width_, kMaxFieldsOfALine); }
  std::int64_t integer(std::size_t from_one) const {
    return tables_.parameters.integer(field(line_.text, width_, from_one - 1), tables_.contexts, block_.context).value_or(0);
  }
  /// A real takes two fields. What isn't a number above 0 counts as 0.
  double positive(std::size_t from_one) const {
    const std::optional<double> value =
        tables_.parameters.real(field(line_.text, width_, from_one - 1, 2), tables_.contexts, block_.context);
    return value && std::isfinite(*value) && *value > 0 ? *value : 0;
  }

 private:
  const DeckTables& tables_;
  const Block& block_;
  BlockLines lines_;
  std::size_t width_;
  Line line_;
  std::string title_;
};

/// What a group of this kind names by its ids; nothing: other groups, or what isn't known.
std::optional<Referred> named_by(const Keyword& keyword) {
  const std::string_view kind = keyword.word(1);
  if (kind == "PART") return Referred::part;
  if (kind == "NODE" || kind == "NODENS") return Referred::node;
  if (kind == "SHEL" || kind == "SHELL" || kind == "SH3N") return Referred::shell;
  if (kind != "GENE" && kind != "GEN_INCR") return std::nullopt;
  const std::string_view word = keyword.word(0);
  if (word == "GRNOD") return Referred::node;
  if (word == "GRPART") return Referred::part;
  return word == "GRSHEL" || word == "GRSH3N" ? std::optional(Referred::shell) : std::nullopt;
}

std::int64_t added_to_ids(const IdOffsets& added, Referred referred) {
  if (referred == Referred::part) return added.part;
  return referred == Referred::node ? added.node : added.element;
}

}  // namespace

void ContactReader::take(const Block& block, const Keyword& keyword, const DeckTables& tables) {
  if (keyword.number(0) <= 0) return;
  const std::string_view word = keyword.word(0), type = keyword.word(1);
  if (word == "INTER" && (type == "TYPE7" || type == "TYPE19") && keyword.words.size() == 2) interfaces_.push_back({&block, keyword});
  if (is_group(word))
    groups_.try_emplace({std::string(word), keyword.number(0) + tables.contexts[block.context].added.set}, Taken{&block, keyword});
}

/// False: what is in it isn't known.
bool ContactReader::add_members(const GroupName& name, const DeckTables& tables, bool away, Followed& followed, ContactSide& side) const {
  const auto group = groups_.find(name);
  if (group == groups_.end()) return false;
  if (!followed.groups.emplace(name, away).second) return true;
  if (followed.depth >= kMaxDepth) return false;
  ++followed.depth;
  const bool known = add_members_of(group->second, tables, away, followed, side);
  --followed.depth;
  return known;
}

bool ContactReader::add_members_of(const Taken& group, const DeckTables& tables, bool away, Followed& followed, ContactSide& side) const {
  const IdOffsets& added = tables.contexts[group.block->context].added;
  const std::string_view kind = group.keyword.word(1);
  ContactLines lines(*group.block, tables);
  const auto add = [&](Referred referred, std::int64_t first, std::int64_t last, std::int64_t step, bool taken) {
    const std::int64_t by = added_to_ids(added, referred);
    if (first > 0 && last >= first)
      side.members.push_back({referred, first + by, last + by, std::max<std::int64_t>(step, 1), taken != away});
  };
  const std::optional<Referred> named = named_by(group.keyword);
  if (!named && !is_group(kind) && !(group.keyword.word(0) == "SURF" && kind == "SEG")) return false;
  while (lines.next()) {
    const std::size_t fields = lines.fields();
    if (kind == "SEG") {
      for (std::size_t f = 2; f <= 5; ++f) add(Referred::node, lines.integer(f), lines.integer(f), 1, false);
    } else if (kind == "GENE" || kind == "GEN_INCR") {
      const std::size_t each = kind == "GENE" ? 2 : 3;
      for (std::size_t f = 1; f + each - 1 <= fields; f += each)
        add(*named, lines.integer(f), lines.integer(f + 1), each == 3 ? lines.integer(f + 2) : 1, false);
    } else {
      for (std::size_t f = 1; f <= fields; ++f) {
        const std::int64_t id = lines.integer(f);
        if (id == 0) continue;
        if (named)
          add(*named, std::abs(id), std::abs(id), 1, id < 0);
        else if (!add_members({std::string(kind), std::abs(id) + added.set}, tables, (id < 0) != away, followed, side))
          return false;
      }
    }
  }
  return true;
}

std::optional<ContactCard> ContactReader::read(const Taken& interface, const DeckTables& tables) const {
  const Block& block = *interface.block;
  const Context& context = tables.contexts[block.context];
  const std::optional<Units> own = tables.units(block.context, interface.keyword.number(1)), main = tables.units(0, 0);
  const double length = own && main ? own->length / main->length : 1;
  const bool of_surfaces = interface.keyword.word(1) == "TYPE19";
  ContactCard card;
  ContactLines lines(block, tables);
  card.keyword = interface.keyword.joined();
  card.id = interface.keyword.number(0) + context.added.other;
  card.title = lines.title();
  if (!lines.next()) return std::nullopt;
  const std::int64_t secondary = lines.integer(1), surface = lines.integer(2), curvature = lines.integer(9);
  std::int64_t kind = lines.integer(5);
  if (of_surfaces && kind == 4) kind = 2;
  if (kind == 1000) kind = 0;
  if (kind < 0 || kind > 3 || !lines.next()) return std::nullopt;
  ContactGap gap;
  gap.variable = kind > 0;
  if (kind >= 2) {
    if (const double scale = lines.positive(1); scale > 0) gap.scale = scale;
    gap.max = lines.positive(3) * length;
  }
  if (!lines.next()) return std::nullopt;
  if (kind == 3) gap.mesh_share = lines.positive(5) > 0 ? lines.positive(5) : kMeshShare;
  if ((curvature == 1 || curvature == 2) && !lines.next()) return std::nullopt;
  if (!lines.next()) return std::nullopt;
  gap.min = lines.positive(5) * length;
  card.gap = gap;
  Followed of_surface, of_secondary;
  ContactSide of_main;
  if (!add_members({"SURF", surface + context.added.set}, tables, false, of_surface, of_main)) return std::nullopt;
  card.b = of_main;
  if (secondary == 0)
    card.a = of_main;
  else if (!add_members({of_surfaces ? "SURF" : "GRNOD", secondary + context.added.set}, tables, false, of_secondary, card.a))
    return std::nullopt;
  return card;
}

ContactCards ContactReader::cards(const DeckTables& tables) const {
  ContactCards cards;
  for (const Taken& interface : interfaces_)
    if (std::optional<ContactCard> card = read(interface, tables)) cards.cards.push_back(std::move(*card));
  return cards;
}

}  // namespace prismesh::mesh::deck::radioss

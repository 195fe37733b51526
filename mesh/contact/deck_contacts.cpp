#include "mesh/contact/deck_contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/parallel_for.h"

namespace prismesh::mesh::contact {

namespace {

constexpr double kShareOfSide = 0.4;  ///< of single surface contacts without SSTHK
constexpr std::size_t kShellGrain = 8192;

/// What a set names, with the sets that it names.
struct Members {
  std::vector<std::uint8_t> parts;
  std::vector<std::uint8_t> shells, nodes;  ///< empty: it names none
};

class MemberFinder {
 public:
  MemberFinder(const Model& model, const References& references, Members& members)
      : model_(model), references_(references), members_(members) {
    members.parts.assign(model.parts->size(), 0);
  }

  void add(Referred referred, std::int64_t id) {
    if (!is_set(referred)) return mark({referred, ReferenceRole::single, id, id});
    // Sets may name themselves, or each other.
    if (std::find(taken_.begin(), taken_.end(), std::pair(referred, id)) != taken_.end()) return;
    taken_.emplace_back(referred, id);
    const auto referrers = references_.referrers();
    std::vector<std::uint8_t> is_of_set(referrers.size(), 0);
    bool any = false;
    for (std::size_t r = 0; r < referrers.size(); ++r)
      if (referrers[r].defines == referred && referrers[r].id == id) is_of_set[r] = 1, any = true;
    if (!any) return;
    std::vector<Reference> taken_away;
    for (const Reference& reference : references_.all()) {
      if (is_of_set[reference.referrer] == 0) continue;
      if (reference.takes_away)
        taken_away.push_back(reference);
      else if (is_set(reference.referred))
        add(reference.referred, reference.first);
      else
        mark(reference);
    }
    for (const Reference& reference : taken_away) mark(reference, 0);
  }

  void mark(const Reference& reference, std::uint8_t as = 1) {
    switch (reference.referred) {
      case Referred::part:
        for (std::size_t p = 0; p < members_.parts.size(); ++p)
          if (reference.names((*model_.parts)[p].id)) members_.parts[p] = as;
        break;
      case Referred::shell:
      case Referred::any_element:
        each_named(
            reference, model_.shell_count(), [&](std::size_t s) { return model_.shell_ids[s]; },
            [&](std::int64_t id) { return model_.find_shell(id).value; }, made(members_.shells, model_.shell_count()), as);
        break;
      case Referred::node:
        each_named(
            reference, model_.node_count(), [&](std::size_t n) { return model_.node_ids[n]; },
            [&](std::int64_t id) { return model_.find_node(id).value; }, made(members_.nodes, model_.node_count()), as);
        break;
      default: break;
    }
  }

 private:
  static std::vector<std::uint8_t>& made(std::vector<std::uint8_t>& marks, std::size_t count) {
    marks.resize(count, 0);
    return marks;
  }

  /// Short ranges by the index of ids, long ones by all ids.
  template <class IdOf, class Find>
  static void each_named(const Reference& reference, std::size_t count, IdOf&& id_of, Find&& find, std::vector<std::uint8_t>& marks,
                         std::uint8_t as) {
    const std::int64_t step = std::max<std::int64_t>(1, reference.step);
    if ((reference.last - reference.first) / step < static_cast<std::int64_t>(count / 8 + 16)) {
      for (std::int64_t id = reference.first; id <= reference.last; id += step)
        if (const std::size_t at = find(id); at < count) marks[at] = as;
      return;
    }
    for (std::size_t at = 0; at < count; ++at)
      if (reference.names(id_of(at))) marks[at] = as;
  }

  const Model& model_;
  const References& references_;
  Members& members_;
  std::vector<std::pair<Referred, std::int64_t>> taken_;  ///< sets that were followed
};

double shortest_side(const Model& model, ShellIndex shell) {
  const ShellNodes& nodes = model.shell(shell);
  const std::size_t corners = nodes.is_triangle() ? 3 : 4;
  double shortest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < corners; ++i)
    shortest = std::min(shortest, (model.position(nodes.node[(i + 1) % corners]) - model.position(nodes.node[i])).norm());
  return shortest;
}

}  // namespace

DeckContacts::DeckContacts(const Model& model, const ContactCards& cards, const References& references) : model_(model), cards_(cards) {
  for (const ContactCard& card : cards.cards) {
    if (card.ties) continue;
    Sides sides;
    sides.card = &card;
    sides.a = find(card.a, references);
    if (card.b) sides.b = find(*card.b, references);
    sides_.push_back(std::move(sides));
  }
}

/// OpenRadioss, i7sti3: a constant gap is the mean thickness of the main surface's shells, the least of a variable one their least
/// thickness; both at most half of its shortest side.
double DeckContacts::least_of_gap(const Sides& sides, const std::vector<double>& own) const {
  const ContactGap& gap = *sides.card->gap;
  if (gap.min > 0) return gap.min;
  const Side& main = sides.b ? *sides.b : sides.a;
  double sum = 0, thinnest = std::numeric_limits<double>::infinity(), shortest = thinnest;
  std::size_t count = 0;
  for (std::size_t s = 0; s < model_.shell_count(); ++s) {
    const ShellIndex shell(s);
    if (model_.is_removed(shell) || !(own[s] > 0) || !sees(main, shell)) continue;
    const double thickness = gap.scale * own[s];
    sum += thickness, ++count;
    thinnest = std::min(thinnest, thickness);
    shortest = std::min(shortest, shortest_side(model_, shell));
  }
  if (count == 0) return 0;
  return std::min(gap.variable ? thinnest : sum / static_cast<double>(count), shortest / 2);
}

GapRule DeckContacts::rule_in(const Sides& sides, ShellIndex shell, double own) const {
  const ContactGap& gap = *sides.card->gap;
  GapRule rule;
  rule.least = sides.least;
  rule.thickness = gap.variable ? gap.scale * own : sides.least;
  if (gap.variable && gap.max > 0) rule.most = gap.max;
  if (gap.variable && gap.mesh_share > 0) rule.by_mesh = 2 * gap.mesh_share * shortest_side(model_, shell);
  return rule;
}

void DeckContacts::offset(ShellIndex shell, double own, ContactThickness& thickness) const {
  const PartIndex part = model_.shell_parts[shell.value];
  if (!part.valid() || !(*model_.parts)[part.value].section) return;
  const auto share = cards_.offset_of_section.find(*(*model_.parts)[part.value].section);
  if (share == cards_.offset_of_section.end()) return;
  if (thickness.offset.empty()) thickness.offset.assign(model_.shell_count(), 0);
  const double offset = share->second * (cards_.offsets == ContactOffsets::of_contact ? thickness.of_shell[shell.value] : own);
  if (std::isfinite(offset)) thickness.offset[shell.value] = offset;
}

DeckContacts::Side DeckContacts::find(const ContactSide& side, const References& references) const {
  Side found;
  found.card = &side;
  found.everything = side.everything;
  if (side.everything || (!side.referred && side.members.empty())) return found;
  Members members;
  MemberFinder finder(model_, references, members);
  if (side.referred) finder.add(*side.referred, side.id);
  for (const bool away : {false, true})
    for (const ContactMember& member : side.members)
      if (member.takes_away == away)
        finder.mark({member.referred, ReferenceRole::range, member.first, member.last, member.step}, away ? 0 : 1);
  if (side.all_but)
    for (std::uint8_t& part : members.parts) part = part == 0;
  found.parts = std::move(members.parts);
  if (members.shells.empty() && members.nodes.empty()) return found;
  const auto is_named = [&](ShellIndex shell) {
    if (!members.shells.empty() && members.shells[shell.value] != 0) return true;
    const ShellNodes& nodes = model_.shell(shell);
    return !members.nodes.empty() &&
           std::all_of(nodes.node.begin(), nodes.node.end(), [&](NodeIndex node) { return members.nodes[node.value] != 0; });
  };
  for (std::size_t s = 0; s < model_.shell_count(); ++s)
    if (!model_.is_removed(ShellIndex(s)) && is_named(ShellIndex(s))) found.shells.push_back(ShellIndex(s));
  return found;
}

bool DeckContacts::sees(const Side& side, ShellIndex shell) const {
  if (side.everything) return true;
  const PartIndex part = model_.shell_parts[shell.value];
  if (part.valid() && part.value < side.parts.size() && side.parts[part.value] != 0) return true;
  return std::binary_search(side.shells.begin(), side.shells.end(), shell);
}

/// [LS-DYNA Keyword] and the solver's own notes on contact thickness.
double DeckContacts::thickness_in(const ContactCard& card, const ContactSide& side, ShellIndex shell, double own) const {
  if (!card.thick) return 0;
  PartContact of_part;
  if (const PartIndex part = model_.shell_parts[shell.value]; part.valid())
    if (const auto found = cards_.of_part.find((*model_.parts)[part.value].id); found != cards_.of_part.end()) of_part = found->second;
  if (of_part.thickness > 0) return of_part.thickness;
  if (side.thickness > 0) return side.thickness;
  if (cards_.thickness > 0) return cards_.thickness;
  double thickness = own * (of_part.scale > 0 ? of_part.scale : side.scale > 0 ? side.scale : 1);
  if (card.limited_by_sides) thickness = std::min(thickness, kShareOfSide * shortest_side(model_, shell));
  return thickness;
}

ContactThickness DeckContacts::thickness() const {
  ContactThickness thickness = section_thickness(model_);
  const bool offset_all = cards_.offsets == ContactOffsets::of_every_shell;
  if (empty() && !offset_all) return thickness;
  const std::vector<double> own = thickness.of_shell;
  std::vector<std::uint8_t> seen(model_.shell_count(), 0);
  std::vector<Sides> all = sides_;
  const bool any_gap = std::any_of(all.begin(), all.end(), [](const Sides& sides) { return sides.card->gap.has_value(); });
  for (Sides& sides : all)
    if (sides.card->gap) sides.least = least_of_gap(sides, own);
  if (any_gap) {
    thickness.rules.resize(model_.shell_count());
    for (std::size_t s = 0; s < own.size(); ++s) thickness.rules[s].thickness = own[s];
  }
  parallel_for(model_.shell_count(), kShellGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      const ShellIndex shell(s);
      if (model_.is_removed(shell)) continue;
      double greatest = 0;
      GapRule rule;
      const auto take = [&](const Sides& sides, const Side& side) {
        if (!sees(side, shell)) return;
        seen[s] = 1;
        GapRule its;
        if (sides.card->gap)
          its = rule_in(sides, shell, own[s]);
        else
          its.thickness = thickness_in(*sides.card, *side.card, shell, own[s]);
        const double in_contact = std::max(its.thickness, its.least);
        if (in_contact > greatest) greatest = in_contact, rule = its;
      };
      for (const Sides& sides : all) {
        take(sides, sides.a);
        if (sides.b) take(sides, *sides.b);
      }
      if (seen[s] == 0) continue;
      thickness.of_shell[s] = greatest;
      if (any_gap) thickness.rules[s] = rule;
    }
  });
  if (cards_.offsets != ContactOffsets::ignored)
    for (std::size_t s = 0; s < model_.shell_count(); ++s)
      if ((seen[s] != 0 || offset_all) && !model_.is_removed(ShellIndex(s))) offset(ShellIndex(s), own[s], thickness);
  take_contact_thickness(model_, seen, thickness);
  return thickness;
}

const ContactCard* DeckContacts::between(ShellIndex a, ShellIndex b) const {
  for (const Sides& sides : sides_) {
    const bool both =
        sides.b ? (sees(sides.a, a) && sees(*sides.b, b)) || (sees(sides.a, b) && sees(*sides.b, a)) : sees(sides.a, a) && sees(sides.a, b);
    if (both) return sides.card;
  }
  return nullptr;
}

}  // namespace prismesh::mesh::contact

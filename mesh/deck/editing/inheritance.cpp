#include "mesh/deck/editing/inheritance.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "mesh/deck/editing/ancestors.h"
#include "mesh/deck/editing/edit_checks.h"
#include "mesh/deck/editing/names.h"
#include "mesh/deck/editing/new_ids.h"
#include "mesh/deck/editing/referrer_text.h"
#include "mesh/deck/editing/text_place.h"
#include "mesh/deck/editing/tied_sets.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck {
namespace {

/// A new node or shell, and those of the deck that it comes from.
struct NewEntity {
  Referred referred = Referred::node;
  std::int64_t id = 0;
  std::vector<std::int64_t> parents;  ///< ids; a shell has one; none: it joins no sets
  bool triangle = false;              ///< a shell with three corners
};

using Singles = std::vector<Reference>;  ///< with the role single

const Referrer& referrer_of(const ModelDifference& difference, const Reference& reference) {
  return difference.deck.references->referrers()[reference.referrer];
}

// --- sets ---

/// Where a card of the same set as `card` is among `sets`.
std::vector<std::uint32_t>::const_iterator set_among(const References& references, const std::vector<std::uint32_t>& sets,
                                                     std::uint32_t card) {
  const auto cards = references.referrers();
  return std::find_if(sets.begin(), sets.end(), [&](std::uint32_t set) { return same_set(cards[set], cards[card]); });
}

/// Sets that name all parents, each once; of a set on several cards, the first that names the first parent.
std::vector<std::uint32_t> sets_of_all_parents(const References& references, const NewEntity& entity) {
  std::vector<std::uint32_t> cards;
  if (entity.parents.empty()) return {};
  for (const Reference& reference : references.naming(entity.referred, entity.parents.front()))
    if (reference.role == ReferenceRole::list || reference.role == ReferenceRole::range) cards.push_back(reference.referrer);
  std::sort(cards.begin(), cards.end());
  cards.erase(std::unique(cards.begin(), cards.end()), cards.end());
  std::erase_if(cards, [&](std::uint32_t card) { return !all_named_by(references, entity.referred, entity.parents, card); });
  std::vector<std::uint32_t> sets;
  for (const std::uint32_t card : cards)
    if (set_among(references, sets, card) == sets.end()) sets.push_back(card);
  return sets;
}

/// A shell joins a set, or the set's companion if the set can't name shells of its kind.
Result<void> join_set(const ModelDifference& difference, std::uint32_t set, const NewEntity& entity, ReferencePlan& plan) {
  const Deck& deck = difference.deck;
  const Referrer& card = deck.references->referrers()[set];
  if (entity.referred != Referred::shell || difference.writer.can_name(card, entity.triangle)) {
    plan.sets[{set, entity.referred == Referred::node}].joining.push_back(entity.id);
    return {};
  }
  const Result<std::optional<std::uint32_t>> companion = difference.writer.companion(deck, set);
  if (!companion)
    return fail(refusal_at(deck, card.file, card.offset,
                           card_name(deck.format, card) + " can't name the " + (entity.triangle ? "triangle " : "quad ") +
                               std::to_string(entity.id) + (companion.error().message.empty() ? "" : ", " + companion.error().message)));
  if (*companion)
    plan.sets[{**companion, false}].joining.push_back(entity.id);
  else
    plan.companions[set].push_back(entity.id);
  return {};
}

/// Errors: a range of ids that doesn't hold all parents holds the new id.
Result<void> join_sets(const ModelDifference& difference, const NewEntity& entity, ReferencePlan& plan) {
  const References& references = *difference.deck.references;
  const std::vector<std::uint32_t> sets = sets_of_all_parents(references, entity);
  std::set<std::uint32_t> joined_by_range;
  for (const Reference& reference : references.naming(entity.referred, entity.id)) {
    const auto own = set_among(references, sets, reference.referrer);
    if (reference.role == ReferenceRole::range && own != sets.end()) {
      joined_by_range.insert(*own);
      continue;
    }
    const Referrer& card = referrer_of(difference, reference);
    return fail(refusal_at(difference.deck, card.file, reference.card,
                           "the new " + std::string(name(entity.referred)) + " " + std::to_string(entity.id) + " would be named by " +
                               card_name(difference.deck.format, card) +
                               ", to which what it comes from doesn't belong; it needs another id"));
  }
  for (const std::uint32_t set : sets)
    if (!joined_by_range.contains(set))
      if (Result<void> joined = join_set(difference, set, entity, plan); !joined) return joined;
  return {};
}

// --- cards that name one node or shell alone ---

/// Cards with this keyword that name a node alone.
Singles singles_of(const References& references, std::int64_t node, const std::string& keyword) {
  Singles singles;
  for (const Reference& reference : references.naming(Referred::node, node))
    if (reference.role == ReferenceRole::single && references.referrers()[reference.referrer].keyword == keyword)
      singles.push_back(reference);
  return singles;
}

/// The text that copies of these cards for a new node would have. Errors: one of them can't be copied.
Result<std::set<std::string>> copied_texts(const ModelDifference& difference, std::int64_t node, const Singles& singles) {
  std::set<std::string> texts;
  for (const Reference& single : singles) {
    const Referrer& card = referrer_of(difference, single);
    const std::int64_t id = id_in_text(difference, Referred::node, node, card);
    const auto copies = difference.writer.copy_single(text_of(difference.deck, card), card, single, std::span(&id, 1));
    if (!copies)
      return fail(refusal_at(difference.deck, card.file, single.card,
                             "the new node " + std::to_string(node) + " can't have a card like this one: " +
                                 card_name(difference.deck.format, card) + " " + copies.error().message));
    for (const Replacement& copy : *copies) texts.insert(std::string(trim(copy.text)));
  }
  return texts;
}

/// Copies the cards of one keyword, `singles`, that name the first parent alone, if such cards name all parents. Errors: they say different
/// things of the parents, or can't be copied.
Result<void> copy_singles(const ModelDifference& difference, const NewEntity& node, const Singles& singles, ReferencePlan& plan) {
  const Deck& deck = difference.deck;
  const Reference& example = singles.front();
  const Referrer& card = referrer_of(difference, example);
  const Inheritance inheritance = difference.writer.inheritance(card, Referred::node);
  if (inheritance == Inheritance::stays) return {};
  std::vector<Singles> others;
  for (std::size_t p = 1; p < node.parents.size(); ++p) {
    others.push_back(singles_of(*deck.references, node.parents[p], card.keyword));
    if (others.back().empty()) return {};
  }
  const auto refuse = [&](const std::string& why) {
    return fail(refusal_at(
        deck, card.file, example.card,
        "the new node " + std::to_string(node.id) + " lies between nodes that " + keyword_name(deck.format, card.keyword) + " " + why));
  };
  if (inheritance == Inheritance::forbids) return refuse("names one by one, which can't be passed on");
  const Result<std::set<std::string>> wanted = copied_texts(difference, node.id, singles);
  if (!wanted) return fail(wanted.error());
  for (const Singles& other : others) {
    const Result<std::set<std::string>> own = copied_texts(difference, node.id, other);
    if (!own) return fail(own.error());
    if (*own != *wanted) return refuse("holds in different ways");
  }
  for (const Reference& single : singles) plan.copies[{single.referrer, single.card}][node.id] = {single, Referred::node};
  return {};
}

// --- nodes and shells ---

/// The deck's node that an added one comes from by the first of each origin.
NodeIndex first_deck_ancestor(const Model& model, NodeIndex node) {
  while (is_added(model, node)) node = origin_of(model, node).parent[0];
  return node;
}

/// A node that lies between no others has no constraints of others, and joins sets only where it is used as others are.
Result<void> plan_placed_node(const ModelDifference& difference, const PlacedNode& placed, ReferencePlan& plan) {
  const Model& model = difference.model;
  NewEntity entity{Referred::node, model.node_ids[placed.node.value], {}};
  if (placed.joins != kJoinsNone)
    for (const NodeIndex ancestor : deck_ancestors(model, placed.node)) entity.parents.push_back(model.node_ids[ancestor.value]);
  if (Result<void> joined = join_sets(difference, entity, plan); !joined || placed.joins != kJoinsTies) return joined;
  const References& references = *difference.deck.references;
  const std::vector<std::uint32_t> common = sets_of_all_parents(references, entity);
  const NodeIndex first = first_deck_ancestor(model, placed.node);
  for (const std::uint32_t set : tied_sets_of(references, model.node_ids[first.value]))
    if (set_among(references, common, set) == common.end())
      if (Result<void> joined = join_set(difference, set, entity, plan); !joined) return joined;
  return {};
}

/// An element that is no shell joins the sets of its example.
Result<void> plan_added_element(const ModelDifference& difference, ElementClass element_class, std::uint32_t element, ReferencePlan& plan) {
  const Model& model = difference.model;
  const auto c = static_cast<std::size_t>(element_class);
  const TopologyChange& change = *model.topology_change;
  const std::uint32_t example = change.element_examples[c][element - change.deck_elements[c]];
  NewEntity entity{referred(element_class), model.elements[c]->id[element], {}};
  if (example != kNoExample) entity.parents.push_back(model.elements[c]->id[example]);
  return join_sets(difference, entity, plan);
}

Result<void> plan_added_node(const ModelDifference& difference, NodeIndex node, DivisionCheck& division, ReferencePlan& plan) {
  const Model& model = difference.model;
  if (const PlacedNode* placed = placed_node(model, node)) return plan_placed_node(difference, *placed, plan);
  NewEntity entity{Referred::node, model.node_ids[node.value], {}};
  for (const NodeIndex ancestor : deck_ancestors(model, node)) entity.parents.push_back(model.node_ids[ancestor.value]);
  if (Result<void> may = as_refusal(division.may_be_between(entity.parents)); !may) return may;
  if (Result<void> joined = join_sets(difference, entity, plan); !joined) return joined;
  const References& references = *difference.deck.references;
  std::map<std::string, Singles> by_keyword;
  for (const Reference& reference : references.naming(Referred::node, entity.parents.front()))
    if (reference.role == ReferenceRole::single) by_keyword[referrer_of(difference, reference).keyword].push_back(reference);
  for (const auto& [keyword, singles] : by_keyword)
    if (Result<void> done = copy_singles(difference, entity, singles, plan); !done) return done;
  return {};
}

Result<void> plan_divided_shell(const ModelDifference& difference, ShellIndex ancestor, const std::vector<ShellIndex>& children,
                                DivisionCheck& division, ReferencePlan& plan) {
  const std::int64_t parent = difference.original.shell_ids[ancestor.value];
  if (Result<void> may = as_refusal(division.may_be_divided(parent)); !may) return may;
  for (const ShellIndex child : children)
    if (Result<void> joined = join_sets(
            difference, {Referred::shell, difference.model.shell_ids[child.value], {parent}, difference.model.shell(child).is_triangle()},
            plan);
        !joined)
      return joined;
  for (const Reference& reference : difference.deck.references->naming(Referred::shell, parent)) {
    if (reference.role != ReferenceRole::single) continue;
    if (difference.writer.inheritance(referrer_of(difference, reference), Referred::shell) == Inheritance::stays) continue;
    for (const ShellIndex child : children)
      plan.copies[{reference.referrer, reference.card}][difference.model.shell_ids[child.value]] = {reference, Referred::shell};
  }
  return {};
}

/// A quad that became a triangle, or the reverse, goes over to the companions of sets that can't name it any more.
Result<void> plan_changed_kind(const ModelDifference& difference, ShellIndex shell, ReferencePlan& plan) {
  const bool triangle = difference.model.shell(shell).is_triangle();
  if (difference.original.shell(shell).is_triangle() == triangle) return {};
  const std::int64_t id = difference.original.shell_ids[shell.value];
  for (const Reference& reference : difference.deck.references->naming(Referred::shell, id)) {
    if (reference.role != ReferenceRole::list || difference.writer.can_name(referrer_of(difference, reference), triangle)) continue;
    plan.sets[{reference.referrer, false}].leaving.push_back(id);
    if (Result<void> joined = join_set(difference, reference.referrer, {Referred::shell, id, {}, triangle}, plan); !joined) return joined;
  }
  return {};
}

}  // namespace

Result<void> plan_inheritance(const ModelDifference& difference, const ShellFamilies& families, ReferencePlan& plan) {
  DivisionCheck division(difference.deck);
  for (const NodeIndex node : difference.changes.added_nodes)
    if (Result<void> done = plan_added_node(difference, node, division, plan); !done) return done;
  for (std::size_t c = 1; c < difference.changes.added_elements.size(); ++c)
    for (const std::uint32_t element : difference.changes.added_elements[c])
      if (Result<void> done = plan_added_element(difference, static_cast<ElementClass>(c), element, plan); !done) return done;
  for (const auto& [ancestor, children] : families)
    if (Result<void> done = plan_divided_shell(difference, ancestor, children, division, plan); !done) return done;
  for (const ShellIndex shell : difference.changes.reshaped_shells)
    if (Result<void> done = plan_changed_kind(difference, shell, plan); !done) return done;
  return {};
}

}  // namespace prismesh::mesh::deck

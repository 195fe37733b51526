#include "mesh/deck/editing/reference_changes.h"

#include <algorithm>
#include <string>
#include <utility>

#include "mesh/deck/editing/edit_checks.h"
#include "mesh/deck/editing/inheritance.h"
#include "mesh/deck/editing/names.h"
#include "mesh/deck/editing/reference_plan.h"
#include "mesh/deck/editing/referrer_text.h"
#include "mesh/deck/editing/segment_changes.h"
#include "mesh/deck/editing/text_place.h"

namespace prismesh::mesh::deck {
namespace {

ShellFamilies families_of(const ModelDifference& difference) {
  ShellFamilies families;
  for (const ShellIndex shell : difference.changes.added_shells) families[deck_ancestor(difference.model, shell)].push_back(shell);
  return families;
}

/// A node or shell that is removed, by its id in the model.
struct RemovedEntity {
  Referred referred = Referred::node;
  std::int64_t id = 0;
};

/// Takes a removed id out of the sets that list it. Errors: another card still names it, or unread text may.
Result<void> plan_removal(const Deck& deck, const RemovedEntity& removed, DeletionCheck& deletion, const SegmentChanges& segments,
                          ReferencePlan& plan) {
  const auto [referred, id] = removed;
  for (const Reference& reference : deck.references->naming(referred, id)) {
    const Referrer& card = deck.references->referrers()[reference.referrer];
    const auto refuse = [&, referred = referred, id = id](const std::string& namer) {
      return fail(refusal_at(deck, card.file, reference.card,
                             std::string(name(referred)) + " " + std::to_string(id) + " can't be removed: " + namer + " names it"));
    };
    if (reference.role == ReferenceRole::list)
      plan.sets[{reference.referrer, referred == Referred::node}].leaving.push_back(id);
    else if (reference.role == ReferenceRole::single)
      return refuse(card_name(deck.format, card));
    else if (reference.role == ReferenceRole::segment && !segments.lines.contains({reference.referrer, reference.card}))
      return refuse("a segment of " + card_name(deck.format, card));
  }
  return as_refusal(deletion.check_unread_text(referred, id));
}

Result<void> plan_removals(const ModelDifference& difference, const SegmentChanges& segments, ReferencePlan& plan) {
  const Model& original = difference.original;
  DeletionCheck deletion(difference.deck);
  for (const ShellIndex shell : difference.changes.removed_shells)
    if (Result<void> done = plan_removal(difference.deck, {Referred::shell, original.shell_ids[shell.value]}, deletion, segments, plan);
        !done)
      return done;
  for (const NodeIndex node : difference.changes.removed_nodes)
    if (Result<void> done = plan_removal(difference.deck, {Referred::node, original.node_ids[node.value]}, deletion, segments, plan); !done)
      return done;
  return {};
}

void add_card(ReferenceChanges& changes, const Referrer& card, std::vector<Replacement> replacements) {
  for (Replacement& replacement : replacements) changes.replacements.push_back({card.file, std::move(replacement)});
  ++changes.cards;
}

Result<void> write_copies(const ModelDifference& difference, const ReferencePlan& plan, ReferenceChanges& changes) {
  const Deck& deck = difference.deck;
  for (const auto& [line, copies] : plan.copies) {
    const Referrer& card = deck.references->referrers()[line.referrer];
    if (Result<void> may = check_changeable(difference, card, line.offset, "it would have to name new ones"); !may) return may;
    std::vector<std::int64_t> ids;
    for (const auto& [id, copied] : copies) ids.push_back(id_in_text(difference, copied.referred, id, card));
    const Reference& single = copies.begin()->second.single;
    Result<std::vector<Replacement>> copied = difference.writer.copy_single(text_of(deck, card), card, single, ids);
    if (!copied) return fail(refusal_at(deck, card.file, line.offset, card_name(deck.format, card) + " " + copied.error().message));
    add_card(changes, card, std::move(*copied));
  }
  return {};
}

/// Ids as the card's text gives them, each once; ascending as in the model.
std::vector<std::int64_t> ids_for_text(const ModelDifference& difference, Referred referred, std::vector<std::int64_t> ids,
                                       const Referrer& card) {
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  for (std::int64_t& id : ids) id = id_in_text(difference, referred, id, card);
  return ids;
}

Result<void> write_sets(const ModelDifference& difference, const ReferencePlan& plan, ReferenceChanges& changes) {
  const Deck& deck = difference.deck;
  for (const auto& [set, change] : plan.sets) {
    const Referrer& card = deck.references->referrers()[set.referrer];
    if (Result<void> may = check_changeable(difference, card, card.offset, "it would have to change"); !may) return may;
    const Referred referred = set.nodes ? Referred::node : Referred::shell;
    const std::vector<std::int64_t> joining = ids_for_text(difference, referred, change.joining, card);
    const std::vector<std::int64_t> leaving = ids_for_text(difference, referred, change.leaving, card);
    Result<std::vector<Replacement>> changed = difference.writer.change_list(text_of(deck, card), card, joining, leaving);
    if (!changed) return fail(refusal_at(deck, card.file, card.offset, card_name(deck.format, card) + " " + changed.error().message));
    add_card(changes, card, std::move(*changed));
  }
  return {};
}

Result<void> write_companions(const ModelDifference& difference, const ReferencePlan& plan, ReferenceChanges& changes) {
  for (const auto& [set, joining] : plan.companions) {
    const Referrer& card = difference.deck.references->referrers()[set];
    if (Result<void> may = check_changeable(difference, card, card.offset, "another set would have to stand behind it"); !may) return may;
    const std::vector<std::int64_t> ids = ids_for_text(difference, Referred::shell, joining, card);
    std::vector<FileReplacement> made = difference.writer.new_companion(difference.deck, set, ids);
    changes.cards += made.size();
    for (FileReplacement& each : made) changes.replacements.push_back(std::move(each));
  }
  return {};
}

}  // namespace

Result<ReferenceChanges> reference_changes(const ModelDifference& difference) {
  const ShellFamilies families = families_of(difference);
  Result<SegmentChanges> segments = segment_changes(difference, families);
  if (!segments) return fail(segments.error());
  ReferencePlan plan;
  if (Result<void> done = plan_inheritance(difference, families, plan); !done) return fail(done.error());
  if (Result<void> done = plan_removals(difference, *segments, plan); !done) return fail(done.error());

  ReferenceChanges changes{std::move(segments->replacements), segments->lines.size()};
  if (Result<void> done = write_copies(difference, plan, changes); !done) return fail(done.error());
  if (Result<void> done = write_sets(difference, plan, changes); !done) return fail(done.error());
  if (Result<void> done = write_companions(difference, plan, changes); !done) return fail(done.error());
  return changes;
}

}  // namespace prismesh::mesh::deck

#include "mesh/deck/editing/text_changes.h"

#include <memory>
#include <utility>

#include "mesh/deck/editing/card_progress.h"
#include "mesh/deck/editing/check_difference.h"
#include "mesh/deck/editing/edit_text.h"
#include "mesh/deck/editing/model_difference.h"
#include "mesh/deck/editing/reference_changes.h"
#include "mesh/deck/editing/write_elements.h"
#include "mesh/deck/editing/write_nodes.h"
#include "mesh/deck/editing/write_shells.h"
#include "mesh/deck/formats/formats.h"

namespace prismesh::mesh::deck {
namespace {

std::size_t cards_to_write(const ModelDifference& difference) {
  const Changes& changes = difference.changes;
  return difference.moved.size() + changes.added_nodes.size() + changes.reshaped_shells.size() + changes.added_shells.size() +
         changes.other_elements();
}

Result<TextChanges> text_changes_of(const ModelDifference& difference, const Progress& progress) {
  if (Result<void> fine = check_difference(difference); !fine) return fail(fine.error());

  TextEdits edits;
  CardProgress card_progress(progress, cards_to_write(difference));
  if (Result<void> done = write_nodes(difference, card_progress, edits); !done) return fail(done.error());
  if (Result<void> done = write_shells(difference, card_progress, edits); !done) return fail(done.error());
  if (Result<void> done = write_elements(difference, card_progress, edits); !done) return fail(done.error());
  insert_new_blocks(edits, difference.deck);

  TextChanges changes;
  if (!difference.changes.empty()) {
    Result<ReferenceChanges> references = reference_changes(difference);
    if (!references) return fail(references.error());
    changes.set_cards = references->cards;
    for (FileReplacement& each : references->replacements) edits.replacements.push_back(std::move(each));
  }
  Result<OrderedReplacements> ordered = in_order(difference.deck, std::move(edits.replacements));
  if (!ordered) return fail(ordered.error());
  changes.by_file = std::move(ordered->by_file);
  changes.lines = ordered->lines;
  changes.rounding = std::move(edits.rounding);
  changes.counts = edits.counts;
  return changes;
}

}  // namespace

Result<TextChanges> text_changes(const Deck& deck, const Model& original, const Model& model, const Progress& progress) {
  const std::unique_ptr<const CardWriter> writer = card_writer(deck.format);
  return text_changes_of({deck, original, model, *writer, changes_between(original, model), moved_nodes(original, model)}, progress);
}

Result<void> can_restructure(const Deck& deck, const Model& original, const Model& model, std::vector<NodeIndex> moved) {
  const std::unique_ptr<const CardWriter> writer = card_writer(deck.format);
  const Result<TextChanges> changes =
      text_changes_of({deck, original, model, *writer, changes_between(original, model), std::move(moved)}, {});
  if (!changes) return fail(changes.error());
  return {};
}

}  // namespace prismesh::mesh::deck

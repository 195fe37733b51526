#include "mesh/deck/editing/write_shells.h"

#include <string>
#include <utility>

#include "mesh/deck/editing/ancestors.h"
#include "mesh/deck/editing/deck_card.h"
#include "mesh/deck/editing/edit_text.h"
#include "mesh/deck/editing/names.h"
#include "mesh/deck/editing/other_kind.h"
#include "mesh/deck/editing/text_place.h"

namespace prismesh::mesh::deck {
namespace {

/// A shell to be written, and the card that serves as its example.
struct ShellTask {
  ShellIndex shell;
  bool added = false;   ///< false: it was reshaped
  ShellIndex ancestor;  ///< the deck's shell that it comes from; itself if it was reshaped
  DeckCard example;     ///< of the ancestor
  std::size_t end = 0;  ///< of the example
};

ShellTask task_of(const ModelDifference& difference, ShellIndex shell, bool added) {
  const ShellIndex ancestor = deck_ancestor(difference.model, shell);
  const DeckCard example = card_of(difference.deck, ancestor);
  return {shell, added, ancestor, example, difference.writer.shell_end(example.ref())};
}

tl::unexpected<Error> refuse_shell(const ModelDifference& difference, const ShellTask& task, const std::string& why) {
  const std::string name = (task.added ? "the new " : "") + shell_name(difference.model, task.shell);
  return fail(refusal_at(difference.deck, task.example.run.file, task.example.offset, name + " " + why));
}

/// What the shell's card must say, with ids as the file gives them. Errors: the shell can't be changed or divided; an id doesn't fit.
Result<ShellCard> wanted_card(const ModelDifference& difference, const ShellTask& task) {
  const auto refuse = [&](const std::string& why) { return refuse_shell(difference, task, why); };
  const CardRun& run = task.example.run;
  if (difference.deck.is_held(run.file)) return refuse("stands in an include that is used twice; it can't be changed");
  if (has_midside_nodes(difference.original, task.ancestor))
    return refuse("would come from a shell with mid-side nodes, which can't be divided or changed");
  ShellCard wanted = shell_card(difference.original, difference.model, task.shell);
  const IdOffsets offsets = difference.deck.offsets_of(run);
  wanted.id -= offsets.element;
  const std::int64_t largest = difference.writer.largest_shell_id(run.style);
  for (std::int64_t& node : wanted.nodes) {
    node -= offsets.node;
    if (node < 1 || node > largest) return refuse("has a node whose id doesn't fit the fields of its card");
  }
  if (wanted.id < 1 || wanted.id > largest) return refuse("has an id that doesn't fit the fields of the cards beside it");
  return wanted;
}

/// Errors: the format can't write the card, or a parameter gives what would have to change.
Result<void> check_written(const ModelDifference& difference, const ShellTask& task, const Result<WrittenCard>& written) {
  if (!written) return refuse_shell(difference, task, written.error().message);
  if (!written->by_parameter) return {};
  const std::string_view example = task.example.text.substr(task.example.offset, task.end - task.example.offset);
  return refuse_shell(difference, task, has_parameter(example) + "; it can't be changed");
}

void count_shell(TextEdits& edits, const ShellTask& task) { ++(task.added ? edits.counts.shells_added : edits.counts.shells_changed); }

void count_written(TextEdits& edits, const ModelDifference& difference, const ShellTask& task, const WrittenCard& written) {
  note_rounding(edits, difference.deck, task.example, written, shell_name(difference.model, task.shell));
  edits.counts.shells_turned += written.turned;
  count_shell(edits, task);
}

/// A shell whose example's card can hold as many corners: on the example's card, or behind it.
Result<void> write_like_example(const ModelDifference& difference, const ShellTask& task, const ShellCard& wanted, TextEdits& edits) {
  Result<WrittenCard> written = difference.writer.shell(task.example.ref(), wanted);
  if (Result<void> fine = check_written(difference, task, written); !fine) return fine;
  count_written(edits, difference, task, *written);
  if (task.added)
    insert_after_card(edits, task.example, task.end, written->text);
  else
    replace_card(edits, task.example, task.end, std::move(written->text));
  return {};
}

/// A shell whose number of corners the example's card can't hold: behind a neighbour with as many, else in a new block, which is for the
/// first of a part with so many corners. The shell's old card goes.
Result<void> write_as_other_kind(const ModelDifference& difference, const ShellTask& task, const ShellCard& wanted, OtherKind& other_kind,
                                 TextEdits& edits) {
  const bool triangle = difference.model.shell(task.shell).is_triangle();
  const std::string becomes = std::string("becomes a ") + (triangle ? "triangle" : "quad");
  if (const std::string why = other_kind.card_that_forbids(task.ancestor, triangle); !why.empty())
    return refuse_shell(difference, task, becomes + ", but " + why);
  const DeckCard& example = task.example;
  const Result<OtherKind::Place> place = other_kind.place(task.ancestor, wanted);
  if (!place) return refuse_shell(difference, task, becomes + " and " + place.error().message);
  if (place->behind.valid()) {
    if (Result<void> fine = check_written(difference, task, place->card); !fine) return fine;
    count_written(edits, difference, task, place->card);
    const DeckCard beside = card_of(difference.deck, place->behind);
    insert_after_card(edits, beside, difference.writer.shell_end(beside.ref()), place->card.text);
  } else {
    add_to_new_block(edits, example, place->block, place->card.text);
    count_shell(edits, task);
  }
  if (!task.added) remove_card(edits, example, task.end);
  return {};
}

Result<void> write_shell(const ModelDifference& difference, ShellIndex shell, bool added, OtherKind& other_kind, TextEdits& edits) {
  const ShellTask task = task_of(difference, shell, added);
  const Result<ShellCard> wanted = wanted_card(difference, task);
  if (!wanted) return fail(wanted.error());
  const bool same_kind = difference.original.shell(task.ancestor).is_triangle() == difference.model.shell(shell).is_triangle();
  const DeckCard& example = task.example;
  if (same_kind || difference.writer.holds_triangles_and_quads(example.ref())) return write_like_example(difference, task, *wanted, edits);
  return write_as_other_kind(difference, task, *wanted, other_kind, edits);
}

Result<void> remove_shell_card(const ModelDifference& difference, ShellIndex shell, TextEdits& edits) {
  const DeckCard card = card_of(difference.deck, shell);
  const std::string name = shell_name(difference.model, shell);
  const auto refuse = [&](const std::string& why) {
    return fail(refusal_at(difference.deck, card.run.file, card.offset, name + " " + why + "; it can't be removed"));
  };
  if (difference.deck.is_held(card.run.file)) return refuse("stands in an include that is used twice");
  if (!difference.writer.stands_alone(card.ref())) return refuse("has no card that is its alone");
  remove_card(edits, card, difference.writer.shell_end(card.ref()));
  ++edits.counts.shells_removed;
  return {};
}

}  // namespace

Result<void> write_shells(const ModelDifference& difference, CardProgress& progress, TextEdits& edits) {
  OtherKind other_kind(difference.deck, difference.original, difference.writer);
  const Changes& changes = difference.changes;
  for (const auto* shells : {&changes.reshaped_shells, &changes.added_shells})
    for (const ShellIndex shell : *shells) {
      if (!progress.next_card()) return fail(cancelled());
      if (Result<void> done = write_shell(difference, shell, shells == &changes.added_shells, other_kind, edits); !done) return done;
    }
  for (const ShellIndex shell : changes.removed_shells)
    if (Result<void> done = remove_shell_card(difference, shell, edits); !done) return done;
  return {};
}

}  // namespace prismesh::mesh::deck

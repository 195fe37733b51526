#include "mesh/deck/editing/write_shells.h"

#include <algorithm>
#include <map>
#include <string>
#include <tuple>
#include <utility>

#include "mesh/deck/editing/ancestors.h"
#include "mesh/deck/editing/deck_card.h"
#include "mesh/deck/editing/edit_text.h"
#include "mesh/deck/editing/names.h"
#include "mesh/deck/editing/text_place.h"
#include "mesh/deck/editing/unread_numbers.h"

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

/// What is looked up for several shells of one save.
struct ShellLookups {
  UnreadNumbers unread;
  std::map<std::tuple<std::uint32_t, PartIndex, bool>, ShellIndex> neighbours;  ///< by file, part and whether it is a triangle
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

bool has_midside_nodes(const Model& model, ShellIndex shell) {
  const auto& all = *model.midside;
  const auto at = std::lower_bound(all.begin(), all.end(), shell, [](const MidsideNodes& m, ShellIndex s) { return m.shell < s; });
  return at != all.end() && at->shell == shell;
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

// --- shells whose number of corners the example's card can't hold ---

/// Which card names the shell and couldn't name it with the other number of corners, as the end of a sentence; empty: none.
std::string card_that_forbids(const ModelDifference& difference, ShellIndex shell, bool triangle, UnreadNumbers& unread_numbers) {
  const References& references = *difference.deck.references;
  const std::int64_t id = difference.original.shell_ids[shell.value];
  for (const Reference& reference : references.naming(Referred::shell, id)) {
    const Referrer& card = references.referrers()[reference.referrer];
    if (!reference.takes_away && !difference.writer.can_name(card, triangle))
      return card_name(difference.deck.format, card) + " names it, which can't name one";
  }
  const UnreadText* unread = unread_numbers.holding_all(Referred::shell, std::span(&id, 1));
  return unread != nullptr ? unread_name(difference.deck, *unread) : "";
}

/// The last shell before the given one in the same part and file that has the wanted number of corners and no mid-side nodes, else the
/// first after it; invalid: none.
ShellIndex find_neighbour(const ModelDifference& difference, ShellIndex shell, bool triangle) {
  const Model& original = difference.original;
  const std::uint32_t file = difference.deck.run_of(shell).file;
  const auto fits = [&](ShellIndex other) {
    return original.shell_parts[other.value] == original.shell_parts[shell.value] && original.shell(other).is_triangle() == triangle &&
           difference.deck.run_of(other).file == file && !has_midside_nodes(original, other);
  };
  for (std::size_t other = shell.value; other-- > 0;)
    if (fits(ShellIndex(other))) return ShellIndex(other);
  for (std::size_t other = shell.value + 1; other < original.shell_count(); ++other)
    if (fits(ShellIndex(other))) return ShellIndex(other);
  return {};
}

/// find_neighbour of the first shell that asks from this file and part; all others of them get the same answer.
ShellIndex neighbour_of(const ModelDifference& difference, ShellIndex shell, bool triangle, ShellLookups& lookups) {
  const std::tuple key(difference.deck.run_of(shell).file, difference.original.shell_parts[shell.value], triangle);
  const auto [known, is_new] = lookups.neighbours.try_emplace(key);
  if (is_new) known->second = find_neighbour(difference, shell, triangle);
  return known->second;
}

/// In a new block, for the first of a part with so many corners. Errors: the reason, as the end of a sentence.
Result<void> write_in_new_block(const ModelDifference& difference, const ShellTask& task, const ShellCard& wanted, bool triangle,
                                TextEdits& edits) {
  const DeckCard& example = task.example;
  const Result<CardWriter::NewBlock> block = difference.writer.block_of_kind(example.ref(), triangle);
  if (!block) return fail(block.error());
  const Result<WrittenCard> written = difference.writer.shell_in_block(example.ref(), wanted);
  if (!written) return fail(written.error());
  if (written->by_parameter) return fail("", "has a field that a parameter gives");
  add_to_new_block(edits, example, *block, written->text);
  count_shell(edits, task);
  return {};
}

/// Behind a neighbour with as many corners, else in a new block. The shell's old card goes.
Result<void> write_as_other_kind(const ModelDifference& difference, const ShellTask& task, const ShellCard& wanted, ShellLookups& lookups,
                                 TextEdits& edits) {
  const bool triangle = difference.model.shell(task.shell).is_triangle();
  const std::string becomes = std::string("becomes a ") + (triangle ? "triangle" : "quad");
  if (const std::string why = card_that_forbids(difference, task.ancestor, triangle, lookups.unread); !why.empty())
    return refuse_shell(difference, task, becomes + ", but " + why);
  const DeckCard& example = task.example;
  const ShellIndex neighbour = neighbour_of(difference, task.ancestor, triangle, lookups);
  Result<WrittenCard> written = fail("", "");
  if (neighbour.valid()) {
    const DeckCard manner = card_of(difference.deck, neighbour);
    written = difference.writer.shell_in_manner(example.ref(), manner.ref(), wanted);
  }
  if (!written) {
    if (const Result<void> done = write_in_new_block(difference, task, wanted, triangle, edits); !done)
      return refuse_shell(difference, task, becomes + " and " + done.error().message);
    if (!task.added) remove_card(edits, example, task.end);
    return {};
  }
  if (Result<void> fine = check_written(difference, task, written); !fine) return fine;
  count_written(edits, difference, task, *written);
  if (!task.added) remove_card(edits, example, task.end);
  const DeckCard beside = card_of(difference.deck, neighbour);
  insert_after_card(edits, beside, difference.writer.shell_end(beside.ref()), written->text);
  return {};
}

Result<void> write_shell(const ModelDifference& difference, ShellIndex shell, bool added, ShellLookups& lookups, TextEdits& edits) {
  const ShellTask task = task_of(difference, shell, added);
  const Result<ShellCard> wanted = wanted_card(difference, task);
  if (!wanted) return fail(wanted.error());
  const bool same_kind = difference.original.shell(task.ancestor).is_triangle() == difference.model.shell(shell).is_triangle();
  const DeckCard& example = task.example;
  if (same_kind || difference.writer.holds_triangles_and_quads(example.ref())) return write_like_example(difference, task, *wanted, edits);
  return write_as_other_kind(difference, task, *wanted, lookups, edits);
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
  ShellLookups lookups{UnreadNumbers(difference.deck), {}};
  const Changes& changes = difference.changes;
  for (const auto* shells : {&changes.reshaped_shells, &changes.added_shells})
    for (const ShellIndex shell : *shells) {
      if (!progress.next_card()) return fail(cancelled());
      if (Result<void> done = write_shell(difference, shell, shells == &changes.added_shells, lookups, edits); !done) return done;
    }
  for (const ShellIndex shell : changes.removed_shells)
    if (Result<void> done = remove_shell_card(difference, shell, edits); !done) return done;
  return {};
}

}  // namespace prismesh::mesh::deck

#include "daemon/modeld/document_keeper.h"

#include <algorithm>
#include <new>
#include <system_error>

#include "base/counted.h"
#include "daemon/modeld/deck_files.h"
#include "daemon/modeld/paths.h"
#include "daemon/modeld/retiring.h"
#include "mesh/deck/data/deck.h"
#include "mesh/deck/open.h"
#include "mesh/document/branches.h"
#include "mesh/document/deck_settings.h"
#include "mesh/document/edit_kinds.h"
#include "mesh/document/history.h"
#include "mesh/document/self_contained.h"
#include "mesh/model/topology_change.h"

namespace prismesh::modeld {

namespace {

namespace fs = std::filesystem;
using namespace mesh::document;
using mesh::deck::OpenedDeck;
using mesh::deck::Warning;

/// After opening a deck has ended the daemon so many times, it isn't reopened automatically.
constexpr std::uint64_t kMaxReopenings = 3;

Result<OpenOptions> options_of(const ipc::Open& request) {
  OpenOptions options;
  if (request.length_unit) {
    options.length_unit = length_unit_from(*request.length_unit);
    if (!options.length_unit) return fail("", "unknown length unit \"" + *request.length_unit + "\": mm, m or in");
  }
  if (request.target_size) options.target_size = *request.target_size;
  options.rules = request.rules;
  if (request.criteria) options.criteria = *request.criteria;
  options.read_settings_file = !request.sandboxed;
  return options;
}

/// Runs the work and turns bad_alloc into an error. The work must change nothing before it returns.
template <class Work>
auto if_memory_allows(const Work& work, const std::string& file) -> decltype(work()) {
  try {
    return work();
  } catch (const std::bad_alloc&) {
    return fail(file, "there isn't enough memory to do this; everything is as it was");
  }
}

/// "undid 2 steps", "did again: 1 step": what was gone through.
std::string words_of_way(std::span<const Edit> way) {
  std::size_t undone = 0, done = 0;
  for (const Edit& edit : way) {
    undone += std::holds_alternative<Undo>(edit) ? 1 : 0;
    done += std::holds_alternative<Redo>(edit) ? 1 : 0;
  }
  if (done == 0) return "undid " + counted(undone, "step");
  return (undone > 0 ? "undid " + counted(undone, "step") + ", " : std::string()) + "did again: " + counted(done, "step");
}

bool differs(const Generation& a, const Generation& b) {
  return &a != &b && (a.model.topology_change != b.model.topology_change || !mesh::moved_nodes(a.model, b.model).empty());
}

}  // namespace

Result<DocumentKeeper::OpenDocument> DocumentKeeper::load(const ipc::Open& request, const Progress& progress) {
  Result<OpenOptions> options = options_of(request);
  if (!options) return fail(std::move(options.error()));
  options->history_bytes = history_bytes_;
  const Result<fs::path> whole = absolute(request.path);
  if (!whole) return fail(whole.error());
  const fs::path& path = *whole;
  std::vector<Warning> warnings;
  if (Result<void> settled = settle_saves(path, request.sandboxed, warnings); !settled) return fail(std::move(settled.error()));
  Result<OpenedDeck> opened = decks_.open(path, request.sandboxed, progress);
  if (!opened) return fail(std::move(opened.error()));
  const Hash128 content = opened->deck->content;
  const fs::path journal_path = folder_.journal(path, content);
  std::vector<Error> unread;
  if (is_there(journal_path)) options->unread_criteria = &unread;  // the journal has their content
  Result<Document> document = mesh::document::open(path, std::move(*opened), *options);
  if (!document) return fail(std::move(document.error()));
  document->make_text = decks_.text_maker(request.sandboxed);
  document->read_variant = decks_.variant_reader(request.sandboxed);
  for (Error& error : unread)
    warnings.push_back({std::move(error.file), error.line, "criteria-not-read",
                        std::move(error.message) + ". The criteria are those that the unsaved edits were made with", 1});
  Result<Journal> journal = is_there(journal_path) ? Journal::recover(journal_path, *document) : Journal::create(journal_path, *document);
  if (!journal) {
    Error error = std::move(journal.error());
    if (is_there(journal_path)) error.message += ". To open the deck without these edits, move that file away";
    return fail(std::move(error));
  }
  if (journal->cut_torn_tail())
    warnings.push_back({journal_path.string(), 0, "torn-journal",
                        "the last edit was being written when the daemon ended; it had not been acknowledged and is left out", 1});
  if (journal->damage()) {
    std::string message = journal->damage()->message;
    if (!journal->takes_edits())
      message +=
          ". What is shown is the deck with the edits before it. No edits are taken until you save the deck, which goes on with what is "
          "shown, or close it and give its edits up; the damaged journal is kept";
    warnings.push_back({journal_path.string(), journal->damage()->line, "damaged-journal", std::move(message), 1});
  }
  for (const fs::path& other : folder_.other_journals(path, content))
    warnings.push_back(
        {path.string(), 0, "deck-changed",
         "the deck was changed by something else since it was last edited here; the unsaved edits of that time are kept in " +
             other.string() + " (`prismesh replay` can apply them)",
         1});
  const std::uint64_t recovered = journal->records();
  Document recorded = *document;
  const std::shared_ptr<const Generation> saved = document->opened;
  std::vector<ipc::DeckFile> files = files_with_shells(*document);
  return OpenDocument{
      request, std::move(*document), std::move(recorded), std::move(*journal), saved, recovered, std::move(warnings), std::move(files),
      {},      std::nullopt};
}

Result<bool> DocumentKeeper::open(const ipc::Open& request, const Progress& progress) {
  if (open_) {
    if (same_file(open_->document.path, request.path)) return false;
    if (is_blocked(request))
      return fail(open_->document.path.string(),
                  "has unsaved edits: save it, keep them for its next opening (prismesh session open --keep), or give them up (--discard)");
  }
  Result<OpenDocument> loaded = if_memory_allows([&] { return load(request, progress); }, request.path);
  if (!loaded) return fail(std::move(loaded.error()));
  if (open_)
    if (Result<void> gone = let_go(request.keep); !gone) return fail(std::move(gone.error()));
  open_ = std::move(*loaded);
  if (const Result<void> noted = folder_.write_session({request, 0}); !noted)
    open_->warnings.push_back({noted.error().file, 0, "session-not-noted",
                               "what is open couldn't be noted, so after a restart it has to be opened by hand: " + noted.error().message,
                               1});
  return true;
}

Result<bool> DocumentKeeper::reopen(const Progress& progress) {
  Result<std::optional<StateFolder::Session>> session = folder_.read_session();
  if (!session) return fail(std::move(session.error()));
  if (!*session) return false;
  StateFolder::Session& last = **session;
  if (last.attempts >= kMaxReopenings)
    return fail(last.open.path, "opening it ended the daemon " + std::to_string(last.attempts) + " times; open it by hand to try again");
  ++last.attempts;
  (void)folder_.write_session(last);  // if that fails, only the number of attempts is lost
  const Result<bool> opened = open(last.open, progress);
  // An error isn't a crash, so it doesn't count as an attempt.
  if (!opened) {
    --last.attempts;
    (void)folder_.write_session(last);
    return fail(opened.error());
  }
  return true;
}

/// The document's generation that a generation of `recorded` is a copy of, or the same.
const Generation* DocumentKeeper::original_of(const Generation* recorded) const {
  for (const Twin& twin : open_->twins)
    if (twin.recorded.get() == recorded) return twin.of.get();
  return recorded;
}

/// The document's generation that an undo or redo of `recorded` leads to; null if `recorded` has no such step.
const Generation* DocumentKeeper::own_step(Prepared::Step step) const {
  const Document& recorded = open_->recorded;
  if (step == Prepared::Step::undo) return recorded.can_undo() ? original_of(recorded.generations[recorded.cursor - 1].get()) : nullptr;
  return recorded.can_redo() ? original_of(recorded.generations[recorded.cursor + 1].get()) : nullptr;
}

/// Turns an undo or redo into a new step of `recorded`, whose history is shorter than the document's after a save.
Prepared DocumentKeeper::as_push(const Prepared& prepared, const Edit& edit) {
  auto next = std::make_shared<Generation>(*prepared.next);
  next->number = open_->recorded.next_number;
  next->made_by = name(edit);
  Prepared push;
  // Uses the document's cap, so that `recorded` can undo each step that the document can undo.
  const HistoryExcess excess = excess_with(open_->recorded, *next);
  push.drop_oldest = excess.generations;
  push.drop_branches = excess.branches;
  push.next = std::move(next);
  std::erase_if(open_->twins, [](const Twin& twin) { return twin.recorded.use_count() == 1; });
  open_->twins.push_back({push.next, prepared.next});
  return push;
}

/// Number of oldest generations that `recorded` drops, so that it keeps all that the document keeps.
std::size_t DocumentKeeper::same_drop(const Prepared& prepared) const {
  const Document &document = open_->document, &recorded = open_->recorded;
  if (prepared.drop_oldest == 0) return 0;
  if (prepared.drop_oldest > document.cursor) return recorded.cursor + 1;
  const Generation* oldest = document.generations[prepared.drop_oldest].get();
  for (std::size_t i = 0; i <= recorded.cursor; ++i)
    if (original_of(recorded.generations[i].get()) == oldest) return i;
  return 0;
}

/// Whether relaxing or repairing found nothing to change: that is no state of the history.
bool DocumentKeeper::did_nothing(const Generation& current, const Edit& edit, const Prepared& prepared) const {
  const EditReport& done = prepared.report;
  return kind_of(edit).group == EditGroup::mending && done.nodes_moved + done.elements_added + done.elements_removed == 0 &&
         !differs(current, *prepared.next);
}

/// Journals the step, then commits it; after an error everything is as before. `recorded`: the step of `recorded`; null: it has none.
Result<void> DocumentKeeper::keep(const Edit& edit, const Prepared* recorded, const Prepared& prepared) {
  OpenDocument& open = *open_;
  // After the record is written, nothing may fail for lack of memory.
  Document next = open.document;
  Document next_recorded = open.recorded;
  commit(next, prepared);
  if (recorded != nullptr) {
    commit(next_recorded, *recorded);
    appending_->begin();
    Result<void> appended = open.journal.append(open.recorded, edit, *recorded);
    appending_->end();
    if (!appended) return appended;
  }
  open.document = std::move(next);
  open.recorded = std::move(next_recorded);
  return {};
}

Result<EditReport> DocumentKeeper::edit(const Edit& edit, const Progress& progress, Clock* clock) {
  if (!open_) return fail("", "no document is open");
  OpenDocument& open = *open_;
  if (open.unfinished)
    return fail(
        open.document.path.string(),
        "its last save isn't finished, and edits made now could be lost: save again to finish it, save under another name, or close "
        "the document");
  if (const auto* branch = std::get_if<TakeBranch>(&edit)) return take_branch(*branch, clock);
  const Result<Edit> whole = self_contained(open.document, edit);
  if (!whole) return fail(whole.error());
  Result<Prepared> prepared = if_memory_allows([&] { return prepare(open.document, *whole, progress, clock); }, "");
  if (!prepared) return fail(std::move(prepared.error()));
  EditReport report = prepared->report;
  if (did_nothing(open.document.current(), *whole, *prepared)) return report;
  const bool push = prepared->step == Prepared::Step::push;
  const bool follows = push || own_step(prepared->step) == prepared->next.get();
  // A delta can add nodes and shells, but can't take a topology change back.
  if (!follows && prepared->step == Prepared::Step::undo &&
      prepared->next->model.topology_change != open.recorded.current().model.topology_change)
    return fail("", "this step can't be undone any more: it changed the structure, and the journal no longer has the state before it");
  Prepared recorded = follows ? *prepared : as_push(*prepared, *whole);
  if (push) {
    recorded.drop_oldest = same_drop(*prepared);
    recorded.drop_branches = excess_with(open.recorded, *recorded.next).branches;
  }
  const std::shared_ptr<const Judging> judging = open.document.current().judging;
  const Result<void> kept = if_memory_allows([&] { return keep(*whole, &recorded, *prepared); }, "");
  if (!kept) return fail(kept.error());
  if (open.document.current().judging != judging) keep_judging(report);
  return report;
}

Result<EditReport> DocumentKeeper::go_to(std::uint64_t generation, const Progress& progress, Clock* clock) {
  if (!open_) return fail("", "no document is open");
  const Document& document = open_->document;
  const Result<std::vector<Edit>> way = way_to(document, generation);
  if (!way) return fail(way.error());
  const std::shared_ptr<const Generation> from = document.generations[document.cursor];
  const std::size_t steps = way->size();
  const bool back = steps > 0 && std::holds_alternative<mesh::document::Undo>(way->back());
  EditReport report;
  report.before = report.after = from->counts;
  report.clusters_before = report.clusters_after = from->clusters->size();
  std::size_t step = 0, common_nodes = from->model.node_count();
  for (; step < steps; ++step) {
    if (progress && !progress(static_cast<double>(step) / static_cast<double>(steps))) {
      report.notes.push_back("stopped after " + std::to_string(step) + " of " + counted(steps, "step"));
      break;
    }
    Result<EditReport> made = edit((*way)[step], {}, clock);
    if (!made && step == 0) return made;
    if (!made) {
      report.notes.push_back("stopped after " + std::to_string(step) + " of " + counted(steps, "step") + ": " + made.error().text());
      break;
    }
    common_nodes = std::min(common_nodes, document.current().model.node_count());
    if (!report.mass_before) report.mass_before = made->mass_before, report.centre_before = made->centre_before;
    if (made->mass_after) report.mass_after = made->mass_after, report.centre_after = made->centre_after;
    report.after = made->after;
    report.clusters_after = made->clusters_after;
    report.milliseconds += made->milliseconds;
  }
  report.edit = back ? "undo" : "redo";
  if (step > 0) report.notes.insert(report.notes.begin(), words_of_way(std::span(*way).first(step)));
  // In branches, nodes that were made after the fork have nothing in common but their place in the order.
  mesh::NodeSet moved = mesh::moved_nodes(from->model, document.current().model);
  std::erase_if(moved, [&](mesh::NodeIndex node) { return node.value >= common_nodes; });
  report.nodes_moved = moved.size();
  report.largest_move.reset();
  if (!moved.empty()) report.largest_move = mesh::largest_move(from->model, document.current().model, moved);
  return report;
}

/// Writes target sizes and criteria beside the deck. They aren't part of the deck, so they don't wait until it is saved.
void DocumentKeeper::keep_judging(EditReport& report) const {
  const Document& document = open_->document;
  if (const Result<void> kept = write_deck_settings(document.current(), document.path); !kept)
    report.notes.push_back("target sizes and criteria are not kept beside the deck: " + kept.error().text());
}

/// The branch of `recorded` whose states are copies of this one's, and that leaves from the current state too. After a save there may be
/// none: then the journal can't name it.
std::optional<std::uint64_t> DocumentKeeper::recorded_branch(const Branch& branch) const {
  for (const Branch& recorded : open_->recorded.branches) {
    const auto is_copy = [&](const auto& copy, const auto& of) { return original_of(copy.get()) == of.get(); };
    if (recorded.fork == open_->recorded.current().number && std::ranges::equal(recorded.states, branch.states, is_copy))
      return recorded.number;
  }
  return std::nullopt;
}

/// Changes what redo leads to. A branch from before a save isn't in the journal: each redo into it is recorded as the resulting state.
Result<EditReport> DocumentKeeper::take_branch(const TakeBranch& edit, Clock* clock) {
  OpenDocument& open = *open_;
  Result<Prepared> prepared = if_memory_allows([&] { return prepare(open.document, edit, {}, clock); }, "");
  if (!prepared) return fail(std::move(prepared.error()));
  const std::optional<std::uint64_t> number = recorded_branch(*find_branch(open.document, edit.number));
  std::optional<Prepared> recorded;
  if (number) {
    recorded = *prepared;
    recorded->branch = *number;
  }
  const Result<void> kept =
      if_memory_allows([&] { return keep(TakeBranch{number.value_or(0)}, recorded ? &*recorded : nullptr, *prepared); }, "");
  if (!kept) return fail(kept.error());
  return prepared->report;
}

bool DocumentKeeper::is_blocked(const ipc::Open& request) const {
  return changed() && !request.discard && !request.keep && !same_file(open_->document.path, request.path);
}

Result<void> DocumentKeeper::close(bool discard, bool keep) {
  if (!open_) return fail("", "no document is open");
  if (is_blocked(ipc::Close{discard, keep}))
    return fail(open_->document.path.string(),
                "has unsaved edits: save it, keep them for its next opening (prismesh session close --keep), or give them up (--discard)");
  if (Result<void> gone = let_go(keep); !gone) return gone;
  folder_.forget_session();
  return {};
}

/// Closes the document. `keep`: with unsaved edits its journal stays, and the next opening of the deck recovers them. Otherwise it is
/// retired, and the next opening begins without them.
Result<void> DocumentKeeper::let_go(bool keep) {
  if (Result<void> ended = end_unfinished_save(); !ended) return ended;
  if (keep && changed()) {
    if (Result<void> in_place = open_->journal.check_in_place(); !in_place) return in_place;
    open_.reset();
    return {};
  }
  const Journal& journal = open_->journal;
  std::error_code problem;
  if (journal.records() == 0 && journal.is_whole())
    fs::remove(journal.path(), problem);
  else if (Result<void> retired = retire_open(folder_, journal, changed() ? ".discarded" : ".closed"); !retired)
    return retired;
  open_.reset();
  return {};
}

bool DocumentKeeper::changed() const { return open_ && differs(*open_->saved, open_->document.current()); }

ipc::DocumentState DocumentKeeper::state() const {
  ipc::DocumentState state;
  if (!open_) return state;
  const Document& document = open_->document;
  const Generation& current = document.current();
  state.open = true;
  state.path = document.path.string();
  state.length_unit = std::string(name(document.settings.length_unit));
  state.length_unit_guessed = document.settings.length_unit_guessed;
  state.target_size = current.judging->deck_size;
  state.target_size_guessed = is_guessed(current.judging->target_size);
  state.generation = current.number;
  state.nodes = mesh::live_nodes(current.model);
  state.shells = mesh::live_shells(current.model);
  state.parts = current.model.parts->size();
  state.selected_nodes = current.selected_nodes;
  state.counts = current.counts;
  state.can_undo = document.can_undo();
  state.can_redo = document.can_redo();
  state.changed = changed();
  state.recovered_edits = open_->recovered;
  state.journalled_edits = open_->journal.records();
  // own_bytes of a generation is the cost of keeping the one before it.
  for (std::size_t i = 1; i < document.generations.size(); ++i) state.history_bytes += document.generations[i]->own_bytes;
  for (const Branch& branch : document.branches) state.history_bytes += bytes_of(branch.states);
  state.history_cap = document.history_bytes;
  for (const auto& generation : document.generations) state.generations.push_back({generation->number, generation->made_by});
  state.files = open_->files;
  state.warnings = document.deck->warnings;
  state.warnings.insert(state.warnings.end(), open_->warnings.begin(), open_->warnings.end());
  state.stored = open_->request.stored;
  return state;
}

}  // namespace prismesh::modeld

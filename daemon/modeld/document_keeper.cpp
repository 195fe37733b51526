#include "daemon/modeld/document_keeper.h"

#include <algorithm>
#include <limits>
#include <new>
#include <system_error>

#include "daemon/modeld/carry_over.h"
#include "daemon/modeld/deck_files.h"
#include "daemon/modeld/save_intent.h"
#include "mesh/deck/deck.h"
#include "mesh/model/growth.h"

namespace prismesh::modeld {

namespace {

namespace fs = std::filesystem;
using namespace mesh::document;
using mesh::deck::OpenedDeck;
using mesh::deck::Warning;

/// A deck that ended so many lives of the daemon isn't opened by itself again.
constexpr std::uint64_t kMaxReopenings = 3;

/// Of a save in place: the rest is reading again what was written.
constexpr double kShareOfWriting = 0.6;

Result<OpenOptions> options_of(const ipc::Open& request) {
  OpenOptions options;
  if (request.length_unit) {
    options.length_unit = length_unit_from(*request.length_unit);
    if (!options.length_unit) return fail("", "unknown length unit \"" + *request.length_unit + "\": mm, m or in");
  }
  options.target_size = request.target_size;
  if (request.criteria) options.criteria = *request.criteria;
  return options;
}

/// What the work gives, or an error where there is too little memory for it. For work that changes nothing until it is done.
template <class Work>
auto if_memory_allows(const Work& work, const std::string& file) -> decltype(work()) {
  try {
    return work();
  } catch (const std::bad_alloc&) {
    return fail(file, "there isn't enough memory to do this; everything is as it was");
  }
}

/// A progress of its own for the part of the work from `begin` to `begin + share`.
Progress part_of(const Progress& whole, double begin, double share) {
  return [&whole, begin, share](double fraction) { return !whole || whole(begin + fraction * share); };
}

bool is_there(const fs::path& path) {
  std::error_code problem;
  return fs::exists(path, problem);
}

bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code problem;
  return fs::equivalent(a, b, problem) && !problem;
}

/// Whether nodes or shells came, went or have other corners since the deck was read.
bool has_grown(const Document& document) { return !mesh::changes_between(document.opened->model, document.current().model).empty(); }

std::string names_of(const SaveIntent& intent) {
  std::string names;
  for (const SaveIntent::File& file : intent.files) names += (names.empty() ? "" : ", ") + file.target.string();
  return names;
}

/// All if it can't be read: then nothing is known to be in it that could be lost by keeping it.
std::uint64_t records_in(const fs::path& journal) {
  const Result<JournalIntents> intents = read_intents(journal);
  return intents ? intents->edits.size() : std::numeric_limits<std::uint64_t>::max();
}

bool differs(const Generation& a, const Generation& b) {
  return &a != &b && (a.model.growth != b.model.growth || !mesh::moved_nodes(a.model, b.model).empty());
}

ipc::Saved report_of(const fs::path& target, const mesh::deck::SaveReport& report) {
  return {target.string(), report.nodes_written, report.lines_changed, report.notes};
}

Result<Journal> start_journal(const StateFolder& folder, const fs::path& path, Document& document) {
  if (!is_there(path)) return Journal::create(path, document);
  // Edits of another time on a deck that looked just like this one were saved or given up since, or their journal would be in
  // use. It isn't deleted.
  if (const Result<fs::path> retired = folder.retire(path, ".old"); !retired) return fail(retired.error());
  return Journal::create(path, document);
}

/// How many of the oldest generations of `recorded` go when another comes, so that it keeps the document's cap too.
std::size_t over_cap(const Document& recorded, const Generation& next) {
  std::size_t total = next.own_bytes;
  for (std::size_t i = 0; i <= recorded.cursor; ++i) total += recorded.generations[i]->own_bytes;
  std::size_t drop = 0;
  for (; total > recorded.history_bytes && drop <= recorded.cursor; ++drop) total -= recorded.generations[drop]->own_bytes;
  return drop;
}

}  // namespace

/// Saves of this deck that were cut off, before it is read: are they finished, did they not begin, can't they be told any more?
Result<void> DocumentKeeper::settle_saves(const fs::path& path, std::vector<Warning>& warnings) {
  const auto warn = [&](const char* kind, std::string message) { warnings.push_back({path.string(), 0, kind, std::move(message), 1}); };
  for (const fs::path& file : folder_.save_intents(path)) {
    const Result<SaveIntent> intent = read_save_intent(file);
    if (!intent) {
      const Result<fs::path> aside = folder_.retire(file, ".damaged");
      if (!aside) return fail(aside.error());
      warn("save-unknown", "a save was cut off, and its record is damaged (" + aside->string() +
                               "): if the deck has several files, some may be from before the save and some from after it");
      continue;
    }
    const Result<SaveOutcome> outcome = settle_save(*intent);
    if (!outcome) return fail(outcome.error());
    const fs::path journal = fs::path(file).replace_extension();  // "....journal.saving"
    if (*outcome == SaveOutcome::finished)
      warn("save-finished", "a save was cut off between the deck's files; the rest has been put in place now");
    if (*outcome == SaveOutcome::mixed)
      warn("save-mixed",
           "a save was cut off between the deck's files, and can't be finished since something else has changed or removed some of them: " +
               names_of(*intent));
    const bool saved = *outcome == SaveOutcome::complete || *outcome == SaveOutcome::finished;
    // Which of the two journals is obsolete; one that holds more than at that time holds edits of later, and stays.
    const fs::path obsolete = saved ? journal : folder_.journal(path, intent->deck_after);
    if (is_there(obsolete) && records_in(obsolete) <= (saved ? intent->records : intent->records_of_next))
      if (const Result<fs::path> retired = folder_.retire(obsolete, saved ? ".saved" : ".unused"); !retired) return fail(retired.error());
    folder_.remove(file);
  }
  return {};
}

Result<DocumentKeeper::OpenDocument> DocumentKeeper::load(const ipc::Open& request, const Progress& progress) {
  Result<OpenOptions> options = options_of(request);
  if (!options) return fail(std::move(options.error()));
  options->history_bytes = history_bytes_;
  const fs::path path = request.path;
  if (!path.is_absolute()) return fail(request.path, "the path must be absolute: the daemon has its own working folder");
  std::vector<Warning> warnings;
  if (Result<void> settled = settle_saves(path, warnings); !settled) return fail(std::move(settled.error()));
  Result<OpenedDeck> opened = mesh::deck::open(path, progress);
  if (!opened) return fail(std::move(opened.error()));
  Result<Document> document = mesh::document::open(path, std::move(*opened), *options);
  if (!document) return fail(std::move(document.error()));

  const Hash128 content = document->deck->content;
  const fs::path journal_path = folder_.journal(path, content);
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
    if (changed())
      return fail(open_->document.path.string(),
                  "has unsaved edits: save it, or give them up (prismesh session close --discard), before another deck is opened");
  }
  Result<OpenDocument> loaded = if_memory_allows([&] { return load(request, progress); }, request.path);
  if (!loaded) return fail(std::move(loaded.error()));
  if (open_)
    if (Result<void> gone = let_go(); !gone) return fail(std::move(gone.error()));
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
  (void)folder_.write_session(last);  // without room for it, only the count of attempts is lost
  const Result<bool> opened = open(last.open, progress);
  // An honest refusal is no crash.
  if (!opened) {
    --last.attempts;
    (void)folder_.write_session(last);
    return fail(opened.error());
  }
  return true;
}

/// The document's generation that one of `recorded` is, or is a copy of.
const Generation* DocumentKeeper::original_of(const Generation* recorded) const {
  for (const Twin& twin : open_->twins)
    if (twin.recorded.get() == recorded) return twin.of.get();
  return recorded;
}

/// The generation that `recorded` would go to by itself; null if it has none.
const Generation* DocumentKeeper::own_step(Prepared::Step step) const {
  const Document& recorded = open_->recorded;
  if (step == Prepared::Step::undo) return recorded.can_undo() ? original_of(recorded.generations[recorded.cursor - 1].get()) : nullptr;
  return recorded.can_redo() ? original_of(recorded.generations[recorded.cursor + 1].get()) : nullptr;
}

/// The journal's form of an undo or redo that its own history, shorter than the document's after a save, can't make.
Prepared DocumentKeeper::as_push(const Prepared& prepared, const Edit& edit) {
  auto next = std::make_shared<Generation>(*prepared.next);
  next->number = open_->recorded.next_number;
  next->made_by = name(edit);
  Prepared push;
  push.drop_oldest = over_cap(open_->recorded, *next);
  push.next = std::move(next);
  std::erase_if(open_->twins, [](const Twin& twin) { return twin.recorded.use_count() == 1; });
  open_->twins.push_back({push.next, prepared.next});
  return push;
}

/// How many of the oldest of `recorded` go, so that it has no less than the document keeps.
std::size_t DocumentKeeper::same_drop(const Prepared& prepared) const {
  const Document &document = open_->document, &recorded = open_->recorded;
  if (prepared.drop_oldest == 0) return 0;
  if (prepared.drop_oldest > document.cursor) return recorded.cursor + 1;
  const Generation* oldest = document.generations[prepared.drop_oldest].get();
  for (std::size_t i = 0; i <= recorded.cursor; ++i)
    if (original_of(recorded.generations[i].get()) == oldest) return i;
  return 0;
}

Result<EditReport> DocumentKeeper::edit(const Edit& edit, const Progress& progress) {
  if (!open_) return fail("", "no document is open");
  OpenDocument& open = *open_;
  if (open.unfinished)
    return fail(
        open.document.path.string(),
        "its last save isn't finished, and edits made now could be lost: save again to finish it, save under another name, or close "
        "the document");
  Result<Prepared> prepared = if_memory_allows([&] { return prepare(open.document, edit, progress); }, "");
  if (!prepared) return fail(std::move(prepared.error()));
  EditReport report = prepared->report;
  const bool push = prepared->step == Prepared::Step::push;
  const bool follows = push || own_step(prepared->step) == prepared->next.get();
  // A delta only ever adds to the structure.
  if (!follows && prepared->step == Prepared::Step::undo && prepared->next->model.growth != open.recorded.current().model.growth)
    return fail("", "this step can't be undone any more: it changed the structure, and the journal no longer has the state before it");
  Prepared recorded = follows ? *prepared : as_push(*prepared, edit);
  if (push) recorded.drop_oldest = same_drop(*prepared);
  // What is on record can't fail for want of memory any more.
  open.recorded.generations.reserve(open.recorded.generations.size() + 1);
  open.document.generations.reserve(open.document.generations.size() + 1);
  if (Result<void> appended = open.journal.append(open.recorded, edit, recorded); !appended) return fail(std::move(appended.error()));
  commit(open.recorded, std::move(recorded));
  commit(open.document, std::move(*prepared));
  return report;
}

Result<ipc::Saved> DocumentKeeper::save(const std::optional<std::string>& path, const Progress& progress) {
  if (!open_) return fail("", "no document is open");
  const fs::path own = open_->document.path;
  if (!path || same_file(own, *path)) return save_in_place(progress);
  const fs::path target = *path;
  if (!target.is_absolute()) return fail(*path, "the path must be absolute: the daemon has its own working folder");
  return save_elsewhere(target, progress);
}

Result<ipc::Saved> DocumentKeeper::save_elsewhere(const fs::path& target, const Progress& progress) {
  const Result<mesh::deck::SaveReport> report = mesh::document::save(open_->document, target, progress);
  if (!report) return fail(report.error());
  open_->saved = open_->document.generations[open_->document.cursor];
  return report_of(target, *report);
}

Result<ipc::Saved> DocumentKeeper::save_in_place(const Progress& progress) {
  OpenDocument& open = *open_;
  if (open.unfinished) {
    ReadySave again = std::move(*open.unfinished);
    open.unfinished.reset();
    return finish_save(std::move(again));
  }
  Result<mesh::deck::StagedSave> staged =
      mesh::document::stage_save(open.document, open.document.path, part_of(progress, 0, kShareOfWriting));
  if (!staged) return fail(std::move(staged.error()));
  if (staged->files().empty()) {
    if (!open.journal.takes_edits())
      if (Result<void> anew = begin_journal_anew(); !anew) return fail(std::move(anew.error()));
    open.saved = open.document.generations[open.document.cursor];
    return report_of(open.document.path, staged->report());
  }
  Result<ReadySave> ready = make_ready(std::move(*staged), part_of(progress, kShareOfWriting, 1 - kShareOfWriting));
  if (!ready) return fail(std::move(ready.error()));
  return finish_save(std::move(*ready));
}

/// A damaged journal makes room for one that holds what is shown. The deck needs no change for it.
Result<void> DocumentKeeper::begin_journal_anew() {
  OpenDocument& open = *open_;
  const fs::path path = open.journal.path();
  if (const Result<fs::path> retired = folder_.retire(path, ".damaged"); !retired) return fail(retired.error());
  Document next = open.document;
  next.generations = {next.opened};
  next.cursor = 0;
  Result<Journal> journal = Journal::create(path, next);
  if (!journal) return fail(std::move(journal.error()));
  if (Result<void> carried = carry_over(open.document.current(), next, *journal); !carried) return carried;
  open.journal = std::move(*journal);
  open.twins = {{next.generations[next.cursor], open.document.generations[open.document.cursor]}};
  open.recorded = std::move(next);
  return {};
}

/// After a save in place the deck on disk is another one, so its text is read again and a new journal begins, with the selection and the
/// parts' states; all of it before the first file is replaced, so that whenever the daemon dies, deck and journal belong together. The
/// history stays, unless nodes or shells came or went: then what was read has other indices, and the history begins anew.
Result<DocumentKeeper::ReadySave> DocumentKeeper::make_ready(mesh::deck::StagedSave staged, const Progress& progress) {
  OpenDocument& open = *open_;
  const std::string path = open.document.path.string();
  Result<OpenedDeck> opened = staged.open(progress);
  if (!opened) return fail(std::move(opened.error()));
  const bool grown = has_grown(open.document);
  const mesh::Model& model = grown ? open.document.current().model : open.document.opened->model;
  if (mesh::live_nodes(opened->model) != mesh::live_nodes(model) || mesh::live_shells(opened->model) != mesh::live_shells(model))
    return fail(path, "the saved deck would not be read as what is shown here; nothing was changed");
  OpenOptions options;
  options.length_unit = open.document.settings.length_unit;
  options.target_size = open.document.settings.target_size;
  if (open.request.criteria) options.criteria = *open.request.criteria;
  options.history_bytes = open.document.history_bytes;
  Result<Document> next = mesh::document::open(open.document.path, std::move(*opened), options);
  if (!next) return fail(std::move(next.error()));
  next->next_number = open.document.next_number;
  if (grown) {
    auto first = std::make_shared<Generation>(*next->opened);
    first->number = next->next_number++;
    next->opened = first;
    next->generations = {next->opened};
  }

  const Generation& current = open.document.current();
  SaveIntent intent = intent_of(staged);
  intent.deck_before = open.document.deck->content;
  intent.deck_after = next->deck->content;
  intent.records = open.journal.records();
  intent.records_of_next = steps_to_carry(current);
  const fs::path intent_file = StateFolder::save_intent(open.journal.path());
  for (const fs::path& other : folder_.save_intents(open.document.path)) folder_.remove(other);
  if (Result<void> written = write_save_intent(intent_file, intent); !written) return fail(std::move(written.error()));
  const fs::path journal_file = folder_.journal(next->path, next->deck->content);
  const auto give_up = [&](Error error) {
    folder_.remove(journal_file);
    folder_.remove(intent_file);
    error.message += "; the deck is as it was";
    return fail(std::move(error));
  };
  Result<Journal> journal = start_journal(folder_, journal_file, *next);
  if (!journal) return give_up(std::move(journal.error()));
  Result<void> carried = grown ? carry_over_by_ids(current, *next, *journal) : carry_over(current, *next, *journal);
  if (!carried) return give_up(std::move(carried.error()));
  ReadySave ready(std::move(staged), intent_file, std::move(*next), std::move(*journal));
  ready.saved = report_of(open.document.path, ready.staged.report());
  ready.grown = grown;
  return ready;
}

/// Replaces the deck's files and goes on with the new journal.
Result<ipc::Saved> DocumentKeeper::finish_save(ReadySave save) {
  OpenDocument& open = *open_;
  if (Result<void> placed = save.staged.put_in_place(); !placed) {
    Error error = std::move(placed.error());
    const bool begun = save.staged.has_begun();
    const Result<void> taken_back = begun ? save.staged.take_back() : Result<void>();
    if (taken_back) {
      forget(save);
      if (begun) error.message += "; the files that had been replaced were given back what they held before";
      return fail(std::move(error));
    }
    error.message += "; giving the others back what they held failed as well (" + taken_back.error().text() +
                     "). Save again to finish the save, or save under another name; no edits are taken until then";
    open.unfinished = std::move(save);
    return fail(std::move(error));
  }
  const fs::path old = open.journal.path();
  const bool whole = open.journal.takes_edits();
  open.journal = std::move(save.journal);
  open.twins.clear();
  if (save.grown) {
    open.document = save.next;
    save.saved.notes.emplace_back(
        "the history begins anew with the saved deck, since nodes or elements came, went or were given other corners");
  } else {
    open.twins.push_back({save.next.generations[save.next.cursor], open.document.generations[open.document.cursor]});
    open.document.deck = save.next.deck;
    open.document.opened = save.next.opened;
    open.document.next_number = std::max(open.document.next_number, save.next.next_number);
  }
  open.saved = open.document.generations[open.document.cursor];
  open.recorded = std::move(save.next);
  // Where this fails the intent stays, and the next opening does it.
  if (const Result<fs::path> retired = folder_.retire(old, whole ? ".saved" : ".damaged"); retired) folder_.remove(save.intent);
  return std::move(save.saved);
}

/// A save that replaced nothing, or has taken back what it replaced: all is as before it.
void DocumentKeeper::forget(ReadySave& save) {
  folder_.remove(save.journal.path());
  folder_.remove(save.intent);
  save.staged = {};
}

/// Before the document is given up: its deck is left whole. Errors: neither way can be gone.
Result<void> DocumentKeeper::end_unfinished_save() {
  if (!open_->unfinished) return {};
  ReadySave save = std::move(*open_->unfinished);
  open_->unfinished.reset();
  if (save.staged.take_back()) {
    forget(save);
    return {};
  }
  const Result<ipc::Saved> finished = finish_save(std::move(save));
  if (!finished) return fail(finished.error());
  return {};
}

Result<void> DocumentKeeper::close(bool discard) {
  if (!open_) return fail("", "no document is open");
  if (!discard && changed())
    return fail(open_->document.path.string(), "has unsaved edits: save it, or give them up (prismesh session close --discard)");
  if (Result<void> gone = let_go(); !gone) return gone;
  folder_.forget_session();
  return {};
}

/// The journal of a document that is given up isn't in the way of the next opening.
Result<void> DocumentKeeper::let_go() {
  if (Result<void> ended = end_unfinished_save(); !ended) return ended;
  const fs::path path = open_->journal.path();
  const bool empty = open_->journal.records() == 0;
  const bool lost = changed();
  std::error_code problem;
  if (empty)
    fs::remove(path, problem);
  else if (const Result<fs::path> retired = folder_.retire(path, lost ? ".discarded" : ".closed"); !retired)
    return fail(retired.error());
  open_.reset();
  return {};
}

bool DocumentKeeper::changed() const { return open_ && differs(*open_->saved, open_->document.current()); }

ipc::State DocumentKeeper::state() const {
  ipc::State state;
  if (!open_) return state;
  const Document& document = open_->document;
  const Generation& current = document.current();
  state.open = true;
  state.path = document.path.string();
  state.length_unit = std::string(name(document.settings.length_unit));
  state.length_unit_guessed = document.settings.length_unit_guessed;
  state.target_size = document.settings.target_size;
  state.target_size_guessed = document.settings.target_size_guessed;
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
  // A generation's own bytes are what keeping the one before it costs.
  for (std::size_t i = 1; i < document.generations.size(); ++i) state.history_bytes += document.generations[i]->own_bytes;
  state.history_cap = document.history_bytes;
  for (const auto& generation : document.generations) state.generations.push_back({generation->number, generation->made_by});
  state.files = open_->files;
  state.warnings = document.deck->warnings;
  state.warnings.insert(state.warnings.end(), open_->warnings.begin(), open_->warnings.end());
  return state;
}

}  // namespace prismesh::modeld

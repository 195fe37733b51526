// Saves the open document: in place, as a copy, or as another deck that becomes the document's.
#include <algorithm>
#include <iterator>

#include "daemon/modeld/carry_over.h"
#include "daemon/modeld/deck_files.h"
#include "daemon/modeld/document_keeper.h"
#include "daemon/modeld/paths.h"
#include "daemon/modeld/retiring.h"
#include "daemon/modeld/save_intent.h"
#include "mesh/deck/data/deck.h"
#include "mesh/deck/open.h"
#include "mesh/deck/save.h"
#include "mesh/document/open.h"
#include "mesh/document/save.h"
#include "mesh/model/topology_change.h"

namespace prismesh::modeld {

namespace {

namespace fs = std::filesystem;
using namespace mesh::document;
using mesh::deck::OpenedDeck;
using mesh::deck::Warning;

/// Share of the progress of a save in place; the rest is for reading the written deck again.
constexpr double kShareOfWriting = 0.6;

/// Maps the progress of a part of the work onto the range from `begin` to `begin + share`.
Progress part_of(const Progress& whole, double begin, double share) {
  return [&whole, begin, share](double fraction) { return !whole || whole(begin + fraction * share); };
}

/// Whether nodes or shells were added, removed or given other corners since the deck was read.
bool has_grown(const Document& document) { return !mesh::changes_between(document.opened->model, document.current().model).empty(); }

std::string names_of(const SaveIntent& intent) {
  std::string names;
  for (const SaveIntent::File& file : intent.files) names += (names.empty() ? "" : ", ") + file.target.string();
  return names;
}

ipc::Saved report_of(const fs::path& target, const mesh::deck::SaveReport& report) {
  return {target.string(), report.nodes_written, report.lines_changed, report.notes};
}

Result<Journal> start_journal(const StateFolder& folder, const fs::path& path, Document& document) {
  if (!is_there(path)) return Journal::create(path, document);
  // A journal of that name holds edits of an earlier time on a deck with the same content; they were saved or discarded since. It is kept.
  if (const Result<fs::path> retired = retire_unopened(folder, path, ".old"); !retired) return fail(retired.error());
  return Journal::create(path, document);
}

/// Gives the document's files the names of another deck with the same content.
void rename_files(Document& document, const Document& other) {
  document.path = other.path;
  const auto rename = [&](std::vector<std::shared_ptr<const Generation>>& generations) {
    for (std::shared_ptr<const Generation>& generation : generations) {
      auto renamed = std::make_shared<Generation>(*generation);
      renamed->relations = other.opened->relations;  // expressions name files by it
      generation = std::move(renamed);
    }
  };
  rename(document.generations);
  for (Branch& branch : document.branches) rename(branch.states);
}

}  // namespace

/// Settles interrupted saves of this deck before it is read: finishes them, or discards those that hadn't begun, and adds a warning where
/// the result is unknown.
/// `sandboxed`: the record of a save that may be beside the deck isn't trusted; those of the state folder are.
Result<void> DocumentKeeper::settle_saves(const fs::path& path, bool sandboxed, std::vector<Warning>& warnings) {
  const auto warn = [&](const char* kind, std::string message) { warnings.push_back({path.string(), 0, kind, std::move(message), 1}); };
  Result<mesh::deck::CutOffSave> cut_off = sandboxed ? mesh::deck::CutOffSave() : mesh::deck::settle_cut_off_save(path);
  if (!cut_off) return fail(std::move(cut_off.error()));
  // What it leaves unsettled is said when the deck is opened.
  const bool is_settled = !cut_off->outcome || *cut_off->outcome == SaveOutcome::finished;
  if (is_settled) std::move(cut_off->warnings.begin(), cut_off->warnings.end(), std::back_inserter(warnings));
  for (const fs::path& file : folder_.save_intents(path)) {
    const Result<SaveIntent> intent = read_save_intent(file);
    if (!intent) {
      const Result<fs::path> aside = folder_.retire(file, kDamaged);
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
    if (*outcome == SaveOutcome::mixed && cut_off->outcome != SaveOutcome::mixed)
      warn("save-mixed",
           "a save was cut off between the deck's files, and can't be finished since something else has changed or removed some of them: " +
               names_of(*intent));
    const bool saved = *outcome == SaveOutcome::complete || *outcome == SaveOutcome::finished;
    const fs::path obsolete = saved ? journal : folder_.journal(path, intent->deck_after);
    const std::uint64_t expected = saved ? intent->records : intent->records_of_next;
    if (Result<void> retired = retire_obsolete(obsolete, saved ? ".saved" : ".unused", expected, warnings); !retired) return retired;
    folder_.remove(file);
  }
  return {};
}

/// Retires one of the two journals of a save. If it holds more records than the save's record says, they are later edits, and it stays.
Result<void> DocumentKeeper::retire_obsolete(const fs::path& journal, const char* ending, std::uint64_t expected,
                                             std::vector<Warning>& warnings) const {
  if (!is_there(journal)) return {};
  const std::optional<std::uint64_t> records = records_in(journal);
  if (records && *records > expected) return {};
  const Result<fs::path> retired = folder_.retire(journal, records ? ending : kDamaged);
  if (!retired) return fail(retired.error());
  if (!records)
    warnings.push_back({retired->string(), 0, "damaged-journal",
                        "this journal belongs to the deck before or after a save that was cut off, and can't be read to its end; it isn't "
                        "used, and is kept as " +
                            retired->string(),
                        1});
  return {};
}

Result<ipc::Saved> DocumentKeeper::save(const std::optional<std::string>& path, const Progress& progress) {
  if (!open_) return fail("", "no document is open");
  if (!path) return save_in_place(progress);
  Result<ipc::Saved> saved = save_copy(*path, progress);
  if (saved) open_->saved = open_->document.generations[open_->document.cursor];
  return saved;
}

Result<ipc::Saved> DocumentKeeper::save_copy(const std::string& path, const Progress& progress) {
  if (!open_) return fail("", "no document is open");
  if (same_file(open_->document.path, path)) return save_in_place(progress);
  const Result<fs::path> target = absolute(path);
  if (!target) return fail(target.error());
  std::vector<Warning> of_earlier_saves;
  if (Result<void> settled = settle_saves(*target, false, of_earlier_saves); !settled) return fail(std::move(settled.error()));
  const Result<mesh::deck::SaveReport> report = mesh::document::save(open_->document, *target, progress);
  if (!report) return fail(report.error());
  return report_of(*target, *report);
}

Result<ipc::Saved> DocumentKeeper::save_as(const std::string& path, const Progress& progress) {
  if (!open_) return fail("", "no document is open");
  OpenDocument& open = *open_;
  if (same_file(open.document.path, path)) return save_in_place(progress);
  const Result<fs::path> target = absolute(path);
  if (!target) return fail(target.error());
  // If neither finishing nor taking back works, the next opening of the deck settles it.
  (void)end_unfinished_save();
  std::vector<Warning> of_earlier_saves;
  if (Result<void> settled = settle_saves(*target, false, of_earlier_saves); !settled) return fail(std::move(settled.error()));
  const Result<mesh::deck::SaveReport> report = mesh::document::save(open.document, *target, part_of(progress, 0, kShareOfWriting));
  if (!report) return fail(report.error());
  ipc::Saved saved = report_of(*target, *report);
  if (Result<void> became = become(*target, part_of(progress, kShareOfWriting, 1 - kShareOfWriting), saved); !became) {
    Error error = std::move(became.error());
    error.message += ". " + path + " is written, as a copy; the document is still " + open.document.path.string();
    return fail(std::move(error));
  }
  return saved;
}

void DocumentKeeper::published_as(const std::string& model) {
  open_->request.stored = model;
  (void)folder_.write_session({open_->request, 0});  // if that fails, a restart takes it for the model that it came from
}

/// Makes the deck that was just written to `target` the document's deck. Whenever the daemon dies, one of the two decks has all edits.
Result<void> DocumentKeeper::become(const fs::path& target, const Progress& progress, ipc::Saved& saved) {
  OpenDocument& open = *open_;
  Result<OpenedDeck> opened = decks_.open(target, open.request.sandboxed, progress);
  if (!opened) return fail(std::move(opened.error()));
  Result<Document> next = read_again(target, std::move(*opened));
  if (!next) return fail(std::move(next.error()));
  const fs::path journal_file = folder_.journal(target, next->deck->content);
  Result<Journal> journal = begin_journal(*next);
  ipc::Open request = open.request;
  request.path = target.string();
  request.stored.clear();
  const Result<void> noted = journal ? folder_.write_session({request, 0}) : fail(journal.error());
  if (!noted) {
    if (journal) folder_.remove(journal_file);  // otherwise it may be another one, which was in the way
    (void)folder_.write_session({open.request, 0});
    return fail(noted.error());
  }
  const Journal old = go_on_with(std::move(*next), std::move(*journal), saved);
  open.request = std::move(request);
  open.files = files_with_shells(open.document);
  open.warnings.clear();
  // An old journal that can't be retired is recovered with its deck, so edits appear twice rather than being lost.
  if (open.unfinished)
    open.unfinished.reset();
  else
    (void)retire_open(folder_, old, ".saved");
  return {};
}

Result<std::optional<ipc::SaveWould>> DocumentKeeper::would(const std::string& path) const {
  if (!open_) return fail("", "no document is open");
  const Document& document = open_->document;
  if (same_file(document.path, path)) return std::nullopt;
  const Result<fs::path> target = absolute(path);
  if (!target) return fail(target.error());
  const Result<std::vector<fs::path>> places =
      mesh::deck::StagedSave::targets(*document.deck, document.opened->model, document.current().model, *target, document.make_text);
  if (!places) return fail(places.error());
  ipc::SaveWould would;
  for (const fs::path& place : *places) {
    if (is_there(place)) would.replace.push_back(place.string());
    const std::string folder = place.parent_path().string();
    if (!is_there(folder) && std::find(would.make.begin(), would.make.end(), folder) == would.make.end()) would.make.push_back(folder);
  }
  if (would.replace.empty() && would.make.empty()) return std::nullopt;
  return would;
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

/// Retires a damaged journal and begins one that holds the document as it is shown. The deck isn't changed.
Result<void> DocumentKeeper::begin_journal_anew() {
  OpenDocument& open = *open_;
  const fs::path path = open.journal.path();
  if (is_there(path))  // the user may have deleted it
    if (const Result<fs::path> retired = folder_.retire(path, kDamaged); !retired) return fail(retired.error());
  Document next = open.document;
  next.generations = {next.opened};
  next.cursor = 0;
  next.branches.clear();
  Result<Journal> journal = Journal::create(path, next);
  if (!journal) return fail(std::move(journal.error()));
  if (Result<void> carried = carry_over(open.document.current(), next, *journal); !carried) return carried;
  open.journal = std::move(*journal);
  open.twins = {{next.generations[next.cursor], open.document.generations[open.document.cursor]}};
  open.recorded = std::move(next);
  return {};
}

/// Reads the document from a deck that it was saved as. Errors: the deck's mesh isn't the document's.
Result<Document> DocumentKeeper::read_again(const fs::path& path, OpenedDeck opened) const {
  const Document& now = open_->document;
  const bool grown = has_grown(now);
  const mesh::Model& model = grown ? now.current().model : now.opened->model;
  if (mesh::live_nodes(opened.model) != mesh::live_nodes(model) || mesh::live_shells(opened.model) != mesh::live_shells(model))
    return fail(path.string(), "the saved deck would not be read as what is shown here; nothing was changed");
  OpenOptions options;
  options.length_unit = now.settings.length_unit;
  options.settings = now.settings;
  options.judged_by = now.current().judging;  // a criteria file may have been removed
  if (!grown) options.like = &now.current();
  options.history_bytes = now.history_bytes;
  Result<Document> next = mesh::document::open(path, std::move(opened), options);
  if (!next) return next;
  next->make_text = now.make_text;
  next->read_variant = now.read_variant;
  next->next_number = now.next_number;
  if (grown) {
    auto first = std::make_shared<Generation>(*next->opened);
    first->number = next->next_number++;
    next->opened = first;
    next->generations = {next->opened};
  }
  return next;
}

/// Begins the journal of a deck that was read again; the selection and the part states are its first steps.
Result<Journal> DocumentKeeper::begin_journal(Document& next) const {
  Result<Journal> journal = start_journal(folder_, folder_.journal(next.path, next.deck->content), next);
  if (!journal) return journal;
  const Document& now = open_->document;
  Result<void> carried = has_grown(now) ? carry_over_by_ids(now.current(), next, *journal) : carry_over(now.current(), next, *journal);
  if (!carried) {
    folder_.remove(journal->path());
    return fail(std::move(carried.error()));
  }
  return journal;
}

/// Makes the saved deck the base that edits are compared with and journalled against. Returns the journal of before.
Journal DocumentKeeper::go_on_with(Document next, Journal journal, ipc::Saved& saved) {
  OpenDocument& open = *open_;
  Journal old = std::exchange(open.journal, std::move(journal));
  open.twins.clear();
  if (has_grown(open.document)) {
    open.document = next;
    saved.notes.emplace_back("the history begins anew with the saved deck, since nodes or elements came, went or were given other corners");
  } else {
    if (next.path != open.document.path) rename_files(open.document, next);
    open.twins.push_back({next.generations[next.cursor], open.document.generations[open.document.cursor]});
    open.document.deck = next.deck;
    open.document.opened = next.opened;
    open.document.next_number = std::max(open.document.next_number, next.next_number);
  }
  open.saved = open.document.generations[open.document.cursor];
  open.recovered = 0;  // they are in the deck now
  open.recorded = std::move(next);
  return old;
}

/// Removes the records of earlier saves of a deck, which were settled when it was opened. One that can't be read is moved aside.
Result<void> DocumentKeeper::remove_intents(const fs::path& deck) const {
  for (const fs::path& intent : folder_.save_intents(deck)) {
    if (read_save_intent(intent)) {
      folder_.remove(intent);
    } else if (const Result<fs::path> retired = folder_.retire(intent, kDamaged); !retired) {
      return fail(retired.error());
    }
  }
  return {};
}

/// Reads the staged deck and begins its journal, with the selection and the part states, before the first file is replaced: whenever the
/// daemon dies, the deck on disk has a journal that fits it. The history stays unless nodes or shells were added or removed: then the
/// indices differ and the history begins anew.
Result<DocumentKeeper::ReadySave> DocumentKeeper::make_ready(mesh::deck::StagedSave staged, const Progress& progress) {
  OpenDocument& open = *open_;
  std::optional<OpenedDeck> known;
  // The cards of a deck that nobody vouches for are looked at by the importer only.
  if (!open.request.sandboxed) known = staged.with_moved_nodes(open.document.opened->model, open.document.current().model);
  if (known && !progress(1)) return fail(cancelled());
  Result<OpenedDeck> opened =
      known ? Result<OpenedDeck>(std::move(*known)) : decks_.open(staged, open.document.path, open.request.sandboxed, progress);
  if (!opened) return fail(std::move(opened.error()));
  Result<Document> next = read_again(open.document.path, std::move(*opened));
  if (!next) return fail(std::move(next.error()));

  SaveIntent intent = intent_of(staged);
  intent.deck_before = open.document.deck->content;
  intent.deck_after = next->deck->content;
  intent.records = open.journal.records();
  intent.records_of_next = steps_to_carry(open.document.current());
  const fs::path intent_file = StateFolder::save_intent(open.journal.path());
  if (Result<void> removed = remove_intents(open.document.path); !removed) return fail(std::move(removed.error()));
  if (Result<void> written = write_save_intent(intent_file, intent); !written) return fail(std::move(written.error()));
  Result<Journal> journal = begin_journal(*next);
  if (!journal) {
    folder_.remove(intent_file);
    journal.error().message += "; the deck is as it was";
    return fail(std::move(journal.error()));
  }
  ReadySave ready(std::move(staged), intent_file, std::move(*next), std::move(*journal));
  ready.saved = report_of(open.document.path, ready.staged.report());
  return ready;
}

/// Replaces the deck's files and switches to the new journal.
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
  save.staged.tell_in_place(*save.next.deck);
  const Journal old = go_on_with(std::move(save.next), std::move(save.journal), save.saved);
  // If this fails the intent stays, and the next opening of the deck retires the journal.
  if (retire_open(folder_, old, ".saved")) folder_.remove(save.intent);
  return std::move(save.saved);
}

/// Discards a save that replaced no file, or has restored the files that it replaced.
void DocumentKeeper::forget(ReadySave& save) {
  folder_.remove(save.journal.path());
  folder_.remove(save.intent);
  save.staged = {};
}

/// Takes an unfinished save back, or else finishes it, so that no deck is left half saved. Errors: neither works.
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

}  // namespace prismesh::modeld

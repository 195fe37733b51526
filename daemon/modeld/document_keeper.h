// Keeps the open document, its journal and its deck on disk consistent: an edit is on disk before it is committed, a save begins a new
// journal, and a restart recovers all edits. Used by one thread; knows no sockets.
#pragma once

#include <memory>
#include <optional>

#include "base/clock.h"
#include "base/progress.h"
#include "daemon/common/watchdog.h"
#include "daemon/modeld/deck_source.h"
#include "daemon/modeld/state_folder.h"
#include "ipc/model/messages.h"
#include "mesh/deck/open.h"
#include "mesh/deck/staged_save.h"
#include "mesh/document/document.h"
#include "mesh/document/edit_report.h"
#include "mesh/document/generation.h"
#include "mesh/document/journal.h"
#include "mesh/document/open.h"
#include "mesh/document/prepare.h"

namespace prismesh::modeld {

class DocumentKeeper {
 public:
  /// `history_bytes`: max. memory of the states kept for undo and redo.
  explicit DocumentKeeper(StateFolder folder, std::size_t history_bytes = mesh::document::OpenOptions{}.history_bytes,
                          DeckSource decks = {})
      : folder_(std::move(folder)), history_bytes_(history_bytes), decks_(std::move(decks)) {}

  /// Opens a deck and recovers the edits in its journal. Closes the document that is open, if its edits are saved; on an error that one
  /// stays open. Returns false if this deck is already open. Errors: of the deck, of the journal, unsaved edits.
  Result<bool> open(const ipc::Open& request, const Progress& progress);
  /// Opens the deck that was open when the daemon ended; returns false if none was. Errors: as `open`; opening this deck ended the daemon
  /// several times.
  Result<bool> reopen(const Progress& progress);
  /// Prepares the edit, journals it, commits it. Errors: of the edit, of the journal.
  Result<mesh::document::EditReport> edit(const mesh::document::Edit& edit, const Progress& progress = {}, Clock* clock = nullptr);
  /// Goes to a state of the history or of one of its branches, step by step. When cancelled, or if a step can't be journalled or undone, it
  /// ends at the state that it has reached. The report is of all steps together. Errors: no such state; why not a single step could be
  /// made.
  Result<mesh::document::EditReport> go_to(std::uint64_t generation, const Progress& progress = {}, Clock* clock = nullptr);
  /// Saves in place, or a copy to `path` that counts as saved. A cancel before the first file is replaced leaves all files as they were; a
  /// later one is ignored. If a save in place fails between two files, the replaced files get their former content back. If that fails
  /// too, edits are refused until `save` is called again and finishes.
  Result<ipc::Saved> save(const std::optional<std::string>& path, const Progress& progress = {});
  /// Writes a copy of the deck. Edits that the document's own deck doesn't hold stay unsaved.
  Result<ipc::Saved> save_copy(const std::string& path, const Progress& progress = {});
  /// Writes the deck to `path` and makes it the document's deck; the history stays, the former deck stays as it is on disk. Errors: as
  /// `save`; the written deck can't be read as the document: then it remains as a copy and the document keeps its deck.
  Result<ipc::Saved> save_as(const std::string& path, const Progress& progress = {});
  /// Returns what a save to `path` would replace or make; nothing, if it would only write new files into existing folders.
  Result<std::optional<ipc::SaveWould>> would(const std::string& path) const;
  /// `keep`: unsaved edits stay in their journal, for the next opening of the deck. Errors: unsaved edits, and neither `discard` nor
  /// `keep`; they can't be kept.
  Result<void> close(bool discard, bool keep = false);
  /// Whether unsaved edits are in the way of this request.
  bool is_blocked(const ipc::Open& request) const;
  bool is_blocked(const ipc::Close& request) const { return changed() && !request.discard && !request.keep; }

  bool is_open() const { return open_.has_value(); }
  const mesh::document::Document& document() const { return open_->document; }
  /// Whether the mesh differs from the deck as it was last opened or saved.
  bool changed() const;
  /// The document's deck was published in the store as this model.
  void published_as(const std::string& model);
  /// All fields but `busy`.
  ipc::DocumentState state() const;

  /// Beats are expected while an edit is written to the journal.
  const daemon::Heartbeat& appending() const { return *appending_; }

 private:
  /// A generation of `recorded` and the generation of the document that it is a copy of.
  struct Twin {
    std::shared_ptr<const mesh::document::Generation> recorded;
    std::shared_ptr<const mesh::document::Generation> of;
  };
  /// A save in place that is ready to replace the deck's files: everything that recovery from the saved deck needs is on disk.
  struct ReadySave {
    mesh::deck::StagedSave staged;
    std::filesystem::path intent;
    mesh::document::Document next;  ///< `recorded` after the save: the saved deck, with the selection and the part states
    mesh::document::Journal journal;
    ipc::Saved saved;

    ReadySave(mesh::deck::StagedSave staged_save, std::filesystem::path intent_file, mesh::document::Document next_document,
              mesh::document::Journal next_journal)
        : staged(std::move(staged_save)),
          intent(std::move(intent_file)),
          next(std::move(next_document)),
          journal(std::move(next_journal)) {}
    ReadySave(ReadySave&&) = default;
    ReadySave& operator=(ReadySave&&) = default;
    /// Leaves the staged files on disk: after the daemon's end the next one finishes the save with them.
    ~ReadySave() { staged.leave(); }
  };
  struct OpenDocument {
    ipc::Open request;
    mesh::document::Document document;
    /// The document as recovery from deck and journal would give it. Equal to `document` until a save in place: after that, `document`
    /// keeps its history and the history of `recorded` begins with the saved deck.
    mesh::document::Document recorded;
    mesh::document::Journal journal;
    std::shared_ptr<const mesh::document::Generation> saved;  ///< what `changed` compares with
    std::uint64_t recovered = 0;
    std::vector<mesh::deck::Warning> warnings;  ///< in addition to the deck's
    std::vector<ipc::DeckFile> files;
    std::vector<Twin> twins;
    std::optional<ReadySave> unfinished;  ///< a save that failed after some files were replaced
  };

  Result<OpenDocument> load(const ipc::Open& request, const Progress& progress);
  Result<void> settle_saves(const std::filesystem::path& path, bool sandboxed, std::vector<mesh::deck::Warning>& warnings);
  Result<void> retire_obsolete(const std::filesystem::path& journal, const char* ending, std::uint64_t expected,
                               std::vector<mesh::deck::Warning>& warnings) const;
  Result<void> remove_intents(const std::filesystem::path& deck) const;
  Result<ipc::Saved> save_in_place(const Progress& progress);
  Result<ReadySave> make_ready(mesh::deck::StagedSave staged, const Progress& progress);
  Result<mesh::document::Document> read_again(const std::filesystem::path& path, mesh::deck::OpenedDeck opened) const;
  Result<mesh::document::Journal> begin_journal(mesh::document::Document& next) const;
  Result<void> become(const std::filesystem::path& target, const Progress& progress, ipc::Saved& saved);
  mesh::document::Journal go_on_with(mesh::document::Document next, mesh::document::Journal journal, ipc::Saved& saved);
  Result<ipc::Saved> finish_save(ReadySave save);
  void forget(ReadySave& save);
  Result<void> end_unfinished_save();
  Result<void> begin_journal_anew();
  bool did_nothing(const mesh::document::Generation& current, const mesh::document::Edit& edit,
                   const mesh::document::Prepared& prepared) const;
  Result<void> keep(const mesh::document::Edit& edit, const mesh::document::Prepared* recorded, const mesh::document::Prepared& prepared);
  Result<mesh::document::EditReport> take_branch(const mesh::document::TakeBranch& edit, Clock* clock);
  std::optional<std::uint64_t> recorded_branch(const mesh::document::Branch& branch) const;
  mesh::document::Prepared as_push(const mesh::document::Prepared& prepared, const mesh::document::Edit& edit);
  const mesh::document::Generation* own_step(mesh::document::Prepared::Step step) const;
  const mesh::document::Generation* original_of(const mesh::document::Generation* recorded) const;
  void keep_judging(mesh::document::EditReport& report) const;
  std::size_t same_drop(const mesh::document::Prepared& prepared) const;
  Result<void> let_go(bool keep);

  StateFolder folder_;
  std::size_t history_bytes_;
  DeckSource decks_;
  std::unique_ptr<daemon::Heartbeat> appending_ = std::make_unique<daemon::Heartbeat>();
  std::optional<OpenDocument> open_;
};

}  // namespace prismesh::modeld

// The open document, its journal and its deck on disk, kept in step: an edit is on disk before it counts, a save gives the
// journal a new base, a restart brings everything back. One thread; no sockets.
#pragma once

#include <memory>
#include <optional>

#include "base/clock.h"
#include "base/progress.h"
#include "daemon/modeld/state_folder.h"
#include "ipc/messages.h"
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
  /// `history_bytes`: what the states kept for undo and redo may take.
  explicit DocumentKeeper(StateFolder folder, std::size_t history_bytes = mesh::document::OpenOptions{}.history_bytes)
      : folder_(std::move(folder)), history_bytes_(history_bytes) {}

  /// Opens a deck and brings back what its journal holds. A document that is open already is given up, which takes that it has
  /// no unsaved edits; on an error it stays. False: this deck was open already. Errors: those of the deck, of the journal,
  /// unsaved edits.
  Result<bool> open(const ipc::Open& request, const Progress& progress);
  /// What was open when the last life ended; false if nothing was. Errors: as `open`; a deck that ended several lives is left.
  Result<bool> reopen(const Progress& progress);
  /// Prepares, journals, commits.
  Result<mesh::document::EditReport> edit(const mesh::document::Edit& edit, const Progress& progress = {}, Clock* clock = nullptr);
  /// Told to stop before the first file is put in place, it leaves all files as they were; from then on it goes on. Where a save in place
  /// fails between the files, those that were replaced get back what they held. If even that fails no edits are taken until the save is
  /// called again and finishes it.
  Result<ipc::Saved> save(const std::optional<std::string>& path, const Progress& progress = {});
  /// Saves the deck elsewhere; edits that its own deck doesn't have stay unsaved.
  Result<ipc::Saved> save_copy(const std::string& path, const Progress& progress = {});
  /// Saves the deck elsewhere and goes on as the document of that deck, with its history; the deck it was stays as it is on disk. Errors:
  /// as save, and where the written deck can't be gone on with: then it is a copy, and the document is the one it was.
  Result<ipc::Saved> save_as(const std::string& path, const Progress& progress = {});
  /// What a save elsewhere would do to what is there; nothing, if it would only write new files into folders that are there.
  Result<std::optional<ipc::SaveWould>> would(const std::string& path) const;
  Result<void> close(bool discard);

  bool is_open() const { return open_.has_value(); }
  const mesh::document::Document& document() const { return open_->document; }
  /// Whether positions differ from what was last opened or saved.
  bool changed() const;
  /// All but `busy`.
  ipc::DocumentState state() const;

 private:
  /// A generation of `recorded` and the document's that it is a copy of.
  struct Twin {
    std::shared_ptr<const mesh::document::Generation> recorded;
    std::shared_ptr<const mesh::document::Generation> of;
  };
  /// A save in place that is ready to replace the deck's files: all that recovery from the saved deck needs is on disk.
  struct ReadySave {
    mesh::deck::StagedSave staged;
    std::filesystem::path intent;
    mesh::document::Document next;  ///< what will be recorded from then on: the saved deck, with the selection and the parts' states
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
    /// The end of the daemon takes nothing from disk that the next one finishes the save with.
    ~ReadySave() { staged.leave(); }
  };
  struct OpenDocument {
    ipc::Open request;
    mesh::document::Document document;
    /// What recovery from the deck on disk and the journal would give. The same as `document` until a save in place: then the
    /// document keeps its history, while the journal's begins with the saved deck.
    mesh::document::Document recorded;
    mesh::document::Journal journal;
    std::shared_ptr<const mesh::document::Generation> saved;  ///< what `changed` compares with
    std::uint64_t recovered = 0;
    std::vector<mesh::deck::Warning> warnings;  ///< beside the deck's
    std::vector<ipc::DeckFile> files;
    std::vector<Twin> twins;
    std::optional<ReadySave> unfinished;  ///< a save that failed when some files were replaced already
  };

  Result<OpenDocument> load(const ipc::Open& request, const Progress& progress);
  Result<void> settle_saves(const std::filesystem::path& path, std::vector<mesh::deck::Warning>& warnings);
  Result<ipc::Saved> save_elsewhere(const std::filesystem::path& target, const Progress& progress);
  Result<ipc::Saved> save_in_place(const Progress& progress);
  Result<ReadySave> make_ready(mesh::deck::StagedSave staged, const Progress& progress);
  Result<mesh::document::Document> read_again(const std::filesystem::path& path, mesh::deck::OpenedDeck opened) const;
  Result<mesh::document::Journal> begin_journal(mesh::document::Document& next) const;
  Result<void> become(const std::filesystem::path& target, const Progress& progress, ipc::Saved& saved);
  void go_on_with(mesh::document::Document next, mesh::document::Journal journal, ipc::Saved& saved);
  Result<ipc::Saved> finish_save(ReadySave save);
  void forget(ReadySave& save);
  Result<void> end_unfinished_save();
  Result<void> begin_journal_anew();
  mesh::document::Prepared as_push(const mesh::document::Prepared& prepared, const mesh::document::Edit& edit);
  const mesh::document::Generation* own_step(mesh::document::Prepared::Step step) const;
  const mesh::document::Generation* original_of(const mesh::document::Generation* recorded) const;
  std::size_t same_drop(const mesh::document::Prepared& prepared) const;
  Result<void> let_go();

  StateFolder folder_;
  std::size_t history_bytes_;
  std::optional<OpenDocument> open_;
};

}  // namespace prismesh::modeld

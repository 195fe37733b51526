// The journal: for each edit its intent (a line of JSON) and its delta, each record checksummed, on disk before anyone is told
// "done". After a crash the document is rebuilt from deck + deltas; only `replay` executes intents again.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "mesh/document/prepare.h"

namespace prismesh::mesh::document {

struct ReplayStep {
  long line = 0;  ///< of the record in the journal, from 1
  std::string edit;
  bool applied = false;
  std::string message;  ///< why not
  EditReport report;
};

/// What a journal holds that can be read by people and scripts.
struct JournalIntents {
  std::string deck_path;
  std::string deck_hash;
  std::vector<Edit> edits;
  std::vector<long> lines;
  bool torn_tail = false;       ///< the last record was incomplete: a crash in the middle of an edit that was never acknowledged
  std::optional<Error> damage;  ///< why nothing behind these edits could be read, with the line
};

class Journal {
 public:
  /// Starts a new journal for a document that has no edits yet. Errors: the file exists, can't be written.
  static Result<Journal> create(const std::filesystem::path& path, const Document& document);
  /// Opens a journal and brings `document` (freshly opened from the same deck) to its last acknowledged state. A torn tail is cut off. So
  /// is a last record that is damaged, and the journal as it was found is kept beside it. Behind damage further up nothing can be read: the
  /// document is as it was up to there, and the journal, left as it is, takes no edits. A length unit or target size that `document` only
  /// guessed is taken from the journal.
  /// Errors: another deck's journal (both hashes named), a damaged header, in use by another process; then `document` is as it was.
  static Result<Journal> recover(const std::filesystem::path& path, Document& document);

  Journal(Journal&&) noexcept;
  Journal& operator=(Journal&&) noexcept;
  ~Journal();

  /// Writes intent and delta of a prepared edit and flushes them to disk. After an error the edit must not be committed, and
  /// the journal is as before. If even that can't be had (a disk that failed to flush, and no room for a new file), this and every
  /// later append is refused with the reason.
  Result<void> append(const Document& document, const Edit& edit, const Prepared& prepared);

  const std::filesystem::path& path() const;
  std::uint64_t records() const;  ///< edits held, undo and redo included
  bool cut_torn_tail() const;     ///< recover found an edit that was never acknowledged
  /// What recover could not read, with the line and what became of it.
  const std::optional<Error>& damage() const;
  /// False: it is damaged, and edits would be lost behind the damage.
  bool takes_edits() const;

 private:
  struct State;
  explicit Journal(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Reads the intents. Plain JSON Lines files of edits (a script) are read as well. `syntax_error` (optional) is set when a line of
/// a script isn't JSON at all. Of a damaged journal all up to the damage. Errors: file and line of the first that can't be read, a damaged
/// header.
Result<JournalIntents> read_intents(const std::filesystem::path& path, bool* syntax_error = nullptr);

/// Executes the intents on a document, going on after an edit that can't be applied. Told to stop, it returns the steps so far. `clock` as
/// for prepare.
std::vector<ReplayStep> replay(Document& document, const JournalIntents& intents, const Progress& progress = {}, Clock* clock = nullptr);

}  // namespace prismesh::mesh::document

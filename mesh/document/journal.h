// The journal: for each edit its intent (a line of JSON) and its delta, with a checksum, on disk before the edit is acknowledged. After a
// crash the document is rebuilt from the deck and the deltas; only `replay` executes intents again.
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

/// The edits of a journal or a script.
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
  /// Opens a journal and brings `document` (freshly opened from the same deck) to its last acknowledged state. Cuts off the beginning of a
  /// last record, and a damaged last record, of which it keeps the journal as found beside it. After earlier damage nothing can be read:
  /// the document gets the edits before it, and the journal is left unchanged and takes no edits. A length unit, target sizes and criteria
  /// that the user didn't give when `document` was opened are taken from the journal. Errors: another deck's journal (both hashes named), a
  /// damaged header, in use by another process; then `document` is unchanged.
  static Result<Journal> recover(const std::filesystem::path& path, Document& document);

  Journal(Journal&&) noexcept;
  Journal& operator=(Journal&&) noexcept;
  ~Journal();

  /// Writes intent (`prepared.as_done`, else `edit`) and delta of a prepared edit and flushes them to disk. After an error the edit must
  /// not be committed, and the journal is as before. If it can't be restored (the disk failed to flush, and has no room for a new file),
  /// this and every later append fails with the reason.
  Result<void> append(const Document& document, const Edit& edit, const Prepared& prepared);

  const std::filesystem::path& path() const;
  std::uint64_t records() const;  ///< edits held, undo and redo included
  bool cut_torn_tail() const;     ///< recover found an edit that was never acknowledged
  /// What recover couldn't read, with the line and what was done about it.
  const std::optional<Error>& damage() const;
  /// False if it is damaged: edits written after the damage would be lost.
  bool takes_edits() const;
  /// Whether the file under this name is this journal and holds its records only: nothing that is damaged or that something else wrote.
  bool is_whole() const;
  /// Errors: the file under this name isn't this journal any more, so what it holds won't be found at the next opening.
  Result<void> check_in_place() const;

 private:
  struct Impl;
  explicit Journal(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Reads the intents of a journal, up to any damage, or of a script (JSON Lines of edits). `syntax_error` (optional) is set if a line of a
/// script isn't JSON. Errors: file and line of the first edit that can't be read, a damaged header.
Result<JournalIntents> read_intents(const std::filesystem::path& path, bool* syntax_error = nullptr);

/// Applies the edits to a document and continues after one that can't be applied. When cancelled it returns the steps so far. `clock` as
/// for prepare.
std::vector<ReplayStep> replay(Document& document, const JournalIntents& intents, const Progress& progress = {}, Clock* clock = nullptr);

}  // namespace prismesh::mesh::document

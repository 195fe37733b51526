// The record of a save in place, written before the first file is replaced. A deck of several files can't be replaced atomically: if the
// daemon dies in between, the next one finishes the save from this record.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "base/error.h"
#include "base/hash.h"
#include "mesh/deck/save_record.h"
#include "mesh/deck/staged_save.h"

namespace prismesh::modeld {

using SaveOutcome = mesh::deck::SaveOutcome;

struct SaveIntent {
  using File = mesh::deck::ReplacedFile;

  Hash128 deck_before, deck_after;    ///< content of the whole deck
  std::uint64_t records = 0;          ///< number in the journal that the save makes obsolete
  std::uint64_t records_of_next = 0;  ///< number in the new journal of the saved deck when it is begun
  std::vector<File> files;            ///< in the order of replacement
};

SaveIntent intent_of(const mesh::deck::StagedSave& save);

/// Writes and flushes the record. Errors: it can't be written.
Result<void> write_save_intent(const std::filesystem::path& path, const SaveIntent& intent);
/// Errors: the record can't be read, or its checksum is wrong.
Result<SaveIntent> read_save_intent(const std::filesystem::path& path);

/// Compares the deck's files with the record and finishes a save that was interrupted between them. Uses only temporary files whose
/// content has the recorded hash; removes temporary files that are no longer needed. Errors: a file can't be replaced.
Result<SaveOutcome> settle_save(const SaveIntent& intent);

}  // namespace prismesh::modeld

// What a save in place is about to do, on disk before the first file is replaced. A deck of several files can't be replaced in one
// step: if the daemon dies in between, the next one finishes the save from this.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "base/error.h"
#include "base/hash.h"
#include "mesh/deck/staged_save.h"

namespace prismesh::modeld {

struct SaveIntent {
  struct File {
    std::filesystem::path target, temporary;
    Hash128 before, after;  ///< what the target holds, and what the temporary file beside it holds
  };
  Hash128 deck_before, deck_after;    ///< content of the whole deck
  std::uint64_t records = 0;          ///< of the journal that the save makes obsolete
  std::uint64_t records_of_next = 0;  ///< of the journal that begins with the saved deck, as it is made
  std::vector<File> files;            ///< in the order they are put in place
};

SaveIntent intent_of(const mesh::deck::StagedSave& save);

/// On disk when it returns. Errors: it can't be written.
Result<void> write_save_intent(const std::filesystem::path& path, const SaveIntent& intent);
/// Errors: it can't be read, it isn't as it was written.
Result<SaveIntent> read_save_intent(const std::filesystem::path& path);

enum class SaveOutcome : std::uint8_t {
  not_begun,  ///< no file was replaced
  complete,   ///< every file was replaced
  finished,   ///< some were not: they are now
  mixed,      ///< some were, and the others can't be any more: something else has changed or removed them
};

/// Looks at the deck's files and finishes a save that was cut off between them. Only bytes that are what the intent says are put in
/// place. Temporary files that nothing needs any more are removed. Errors: the rest can't be put in place.
Result<SaveOutcome> settle_save(const SaveIntent& intent);

}  // namespace prismesh::modeld

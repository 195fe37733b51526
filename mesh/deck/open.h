// Opens decks of every format.
#pragma once

#include <filesystem>
#include <memory>

#include "base/error.h"
#include "base/progress.h"
#include "mesh/deck/data/deck.h"
#include "mesh/deck/data/reading.h"
#include "mesh/model/model.h"

namespace prismesh::mesh::deck {

struct OpenedDeck {
  std::shared_ptr<const Deck> deck;
  Model model;  ///< complete, with adjacency
};

/// Opens a deck with its includes. A save of it that was cut off between its files is finished before, or a warning says that it can't be
/// (save_record.h). `stand_ins`: files to read in place of others; then no save is looked for. Errors: the file can't be read; it is no
/// deck (with what it looks like); this build doesn't read its format (with its name); a card that matters is malformed (file and line); it
/// is being saved; cancelled.
Result<OpenedDeck> open(const std::filesystem::path& path, const Progress& progress = {}, const StandIns& stand_ins = {});

/// Opens a deck whose files come from elsewhere, and no more of it than the limits allow. No save is looked for. `stand_ins`: by the
/// canonical names of `files`. Errors: as above; the limit that is exceeded, with its number and the file (ErrorKind::over_limit).
Result<OpenedDeck> open_within(const FileAccess& files, const ReadingLimits& limits, const std::filesystem::path& path,
                               const Progress& progress = {}, const StandIns& stand_ins = {});

}  // namespace prismesh::mesh::deck

// What a save in place is about to do, on disk before the first file is replaced. A deck of several files can't be replaced in one
// step: if the daemon dies in between, the next one finishes the save from this.
#pragma once

#include <filesystem>

#include "base/error.h"
#include "base/hash.h"
#include "base/progress.h"
#include "mesh/document/document.h"

namespace prismesh::modeld {

/// Whether nodes or shells came, went or have other corners since the deck was read.
bool has_grown(const mesh::document::Document& document);

/// Writes the intent of saving the document's current generation to its own deck. Errors: those of saving, cancelled.
Result<void> write_save_intent(const std::filesystem::path& path, const mesh::document::Document& document, const Progress& progress = {});

enum class SaveOutcome : std::uint8_t {
  not_begun,  ///< the deck is as it was
  complete,   ///< every file was replaced
  finished,   ///< some were not: they are now
  unknown,    ///< the deck isn't the one that was being saved any more
};

/// Looks at the deck (as just read) and finishes the save where it was cut off. After `finished` the deck must be read again.
/// Errors: the intent can't be read, the rest can't be written.
Result<SaveOutcome> settle_save(const std::filesystem::path& path, const std::filesystem::path& deck_path,
                                const mesh::deck::OpenedDeck& opened);

}  // namespace prismesh::modeld

// Reads decks for the document keeper and makes their new text: in this process, or by prismesh-import for a deck that nobody vouches for.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/progress.h"
#include "ipc/import/client.h"
#include "mesh/deck/editing/text_changes.h"
#include "mesh/deck/open.h"
#include "mesh/deck/staged_save.h"
#include "mesh/document/document.h"

namespace prismesh::modeld {

/// How prismesh-import is reached.
struct ImporterPlace {
  std::filesystem::path socket;   ///< of the service manager; used if it is there
  std::filesystem::path program;  ///< else started
};

class DeckSource {
 public:
  DeckSource() = default;
  explicit DeckSource(ImporterPlace importer) : importer_(std::move(importer)) {}

  /// Reads a deck. Sandboxed: no save that was cut off is looked for. Errors: those of deck::open or ipc::import_deck.
  Result<mesh::deck::OpenedDeck> open(const std::filesystem::path& path, bool sandboxed, const Progress& progress) const;
  /// Reads the deck at `path` as it will be once the save is in place.
  Result<mesh::deck::OpenedDeck> open(const mesh::deck::StagedSave& save, const std::filesystem::path& path, bool sandboxed,
                                      const Progress& progress) const;
  /// Makes the new text of an edited deck. Doesn't need this object any more.
  mesh::deck::TextMaker text_maker(bool sandboxed) const;
  /// Reads the decks that edits of a document name, as its own deck was read. Likewise.
  mesh::document::DeckReader variant_reader(bool sandboxed) const;

 private:
  ipc::ImportOptions options(const Progress& progress) const;

  ImporterPlace importer_;
};

}  // namespace prismesh::modeld

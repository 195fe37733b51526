// Has a deck read, or the new text of an edited one made, by prismesh-import: in a process of its own that is locked in. Takes over the
// result.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/progress.h"
#include "ipc/import/messages.h"
#include "mesh/deck/editing/text_changes.h"
#include "mesh/deck/open.h"

namespace prismesh::ipc {

struct ImportedDeck {
  mesh::deck::OpenedDeck opened;
  std::vector<std::string> unguarded;  ///< Imported::unguarded
};

struct ImportOptions {
  std::filesystem::path program;  ///< prismesh-import
  /// Of a station's service manager, which starts prismesh-import for each connection. Empty: `program` is started.
  std::filesystem::path socket{};
  ImportLimits limits{};
  std::chrono::seconds patience{600};
  std::vector<StandIn> stand_ins{};
  Progress progress{};  ///< called a few times a second
};

/// Starts the program and waits for its answer. The includes are those in the deck's folder and beneath it. Whatever happens to the
/// program, it has ended when this returns, or its connection has. Errors: those of reading the deck; the program can't be started,
/// crashes, uses up a limit or the patience; what it hands over is damaged; cancelled.
Result<ImportedDeck> import_deck(const std::filesystem::path& deck, const ImportOptions& options);

/// Has the new text made that saving an edited deck needs (mesh/deck/editing/text_changes.h), by a process that reads the deck once more.
/// `deck`: as it was taken over from import_deck. `original`: its model; `model`: as edited from it. Errors: as import_deck; those of
/// text_changes; the deck on disk isn't the one that was read any more.
Result<mesh::deck::TextChanges> rewrite_deck(const mesh::deck::Deck& deck, const mesh::Model& original, const mesh::Model& model,
                                             const ImportOptions& options);

}  // namespace prismesh::ipc

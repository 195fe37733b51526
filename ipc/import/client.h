// Has a deck read by prismesh-import, in a process of its own that is locked in, and takes it over.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/progress.h"
#include "ipc/import/messages.h"
#include "mesh/deck/open.h"

namespace prismesh::ipc {

struct ImportedDeck {
  mesh::deck::OpenedDeck opened;
  std::vector<std::string> unguarded;  ///< Imported::unguarded
};

struct ImportOptions {
  std::filesystem::path program;  ///< prismesh-import
  ImportLimits limits{};
  std::chrono::seconds patience{600};
  Progress progress{};  ///< called a few times a second
};

/// Starts the program and waits for its answer. The includes are those in the deck's folder and beneath it. Whatever happens to the
/// program, it has ended when this returns. Errors: those of reading the deck; the program can't be started, crashes, uses up a limit or
/// the patience; what it hands over is damaged; cancelled.
Result<ImportedDeck> import_deck(const std::filesystem::path& deck, const ImportOptions& options);

}  // namespace prismesh::ipc

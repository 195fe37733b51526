// Radioss starter decks in block format: see docs/formats/radioss.md.
#pragma once

#include <filesystem>

#include "base/file.h"
#include "base/progress.h"
#include "mesh/deck/deck.h"

namespace prismesh::mesh::deck::radioss {

/// Reads the deck whose main file holds `main`. Errors as deck::open.
Result<OpenedDeck> read(const std::filesystem::path& path, FileBytes main, const Progress& progress);

}  // namespace prismesh::mesh::deck::radioss

// Radioss starter decks in block format: see docs/formats/radioss.md.
#pragma once

#include "base/progress.h"
#include "mesh/deck/deck.h"
#include "mesh/deck/file_set.h"

namespace prismesh::mesh::deck::radioss {

/// `files` holds the main file. Errors: those of deck::open.
Result<OpenedDeck> read(FileSet files, const Progress& progress);

}  // namespace prismesh::mesh::deck::radioss

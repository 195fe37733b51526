// Radioss starter decks in block format: see docs/formats/radioss.md.
#pragma once

#include "base/error.h"
#include "mesh/deck/assembly/deck_contents.h"
#include "mesh/deck/assembly/file_set.h"
#include "mesh/deck/assembly/watch.h"

namespace prismesh::mesh::deck::radioss {

/// `files` holds the main file. Errors: as read in formats/formats.h.
Result<DeckContents> read(FileSet files, Watch& watch);

}  // namespace prismesh::mesh::deck::radioss

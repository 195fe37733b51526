// Reads Nastran bulk data: walks over its files, reads all cards in parallel, and puts the model together.
#pragma once

#include "base/progress.h"
#include "mesh/deck/deck.h"
#include "mesh/deck/file_set.h"

namespace prismesh::mesh::deck::nastran {

/// `files` holds the main file. Errors: those of deck::open.
Result<OpenedDeck> read(FileSet files, const Progress& progress);

}  // namespace prismesh::mesh::deck::nastran

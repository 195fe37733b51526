// Reads Nastran bulk data: walks over its files, and reads all cards in parallel.
#pragma once

#include "base/error.h"
#include "mesh/deck/assembly/file_set.h"
#include "mesh/deck/assembly/read_pieces.h"

namespace prismesh::mesh::deck::nastran {

/// `files` holds the main file. Errors: as read in formats/formats.h.
Result<DeckContents> read(FileSet files, Watch& watch);

}  // namespace prismesh::mesh::deck::nastran

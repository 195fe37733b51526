// Reads an Abaqus input deck (also CalculiX's) with its includes.
#pragma once

#include "base/error.h"
#include "mesh/deck/assembly/file_set.h"
#include "mesh/deck/assembly/read_pieces.h"

namespace prismesh::mesh::deck::abaqus {

/// `files` holds the main file. Errors: as read in formats/formats.h.
Result<DeckContents> read(FileSet files, Watch& watch);

}  // namespace prismesh::mesh::deck::abaqus

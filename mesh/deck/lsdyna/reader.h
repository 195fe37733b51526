// Reads an LS-DYNA keyword deck: walks over its files, reads the mesh in parallel, and puts the model together.
#pragma once

#include "base/error.h"
#include "mesh/deck/assembly/deck_contents.h"
#include "mesh/deck/assembly/file_set.h"
#include "mesh/deck/assembly/watch.h"

namespace prismesh::mesh::deck::lsdyna {

/// `files` holds the main file. Errors: as read in formats/formats.h.
Result<DeckContents> read(FileSet files, Watch& watch);

}  // namespace prismesh::mesh::deck::lsdyna

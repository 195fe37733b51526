// Reads an Abaqus input deck (also CalculiX's) with its includes.
#pragma once

#include "base/progress.h"
#include "mesh/deck/deck.h"
#include "mesh/deck/file_set.h"

namespace prismesh::mesh::deck::abaqus {

/// `files` holds the main file. Errors: those of deck::open.
Result<OpenedDeck> read(FileSet files, const Progress& progress);

}  // namespace prismesh::mesh::deck::abaqus

// The quick pass over an Abaqus deck: follows includes, notes keywords, parts and instances, and cuts the mesh into pieces of about equal
// size.
#pragma once

#include "base/error.h"
#include "mesh/deck/abaqus/outline.h"
#include "mesh/deck/assembly/file_set.h"

namespace prismesh::mesh::deck::abaqus {

/// Errors: all instances together would need more memory than this version takes.
Result<DeckOutline> walk(FileSet files);

}  // namespace prismesh::mesh::deck::abaqus

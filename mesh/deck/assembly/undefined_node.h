// Warns of elements that are left out. Private to assembly.
#pragma once

#include "mesh/deck/assembly/assembled.h"
#include "mesh/deck/assembly/warnings.h"

namespace prismesh::mesh::deck {

void note_undefined_node(Warnings& warnings, const UndefinedNode& undefined);

}  // namespace prismesh::mesh::deck

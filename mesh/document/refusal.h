// Refuses to move nodes that must keep their positions. Private to mesh/document.
#pragma once

#include "base/error.h"
#include "mesh/deck/data/deck.h"
#include "mesh/document/generation.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::document {

/// An error if one of `nodes` belongs to a locked part or its coordinates can't be written: names the first, why, and how many.
/// `deck` (may be null) adds the file, the line and the parameter's name.
Result<void> refuse_held(const Generation& generation, const NodeSet& nodes, const deck::Deck* deck);

}  // namespace prismesh::mesh::document

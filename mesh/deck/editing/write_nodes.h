// Writes the cards of nodes that were moved, added or removed.
#pragma once

#include "base/error.h"
#include "mesh/deck/editing/card_progress.h"
#include "mesh/deck/editing/model_difference.h"
#include "mesh/deck/editing/text_edits.h"

namespace prismesh::mesh::deck {

/// Adds new coordinates of moved nodes, then cards of added nodes, then removals to `edits`. Errors: a node can't be written or removed
/// safely (file and line of the card that stands in the way, and the reason); cancelled.
Result<void> write_nodes(const ModelDifference& difference, CardProgress& progress, TextEdits& edits);

}  // namespace prismesh::mesh::deck

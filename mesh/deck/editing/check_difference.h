// Checks what no format can write, before any card is written.
#pragma once

#include "base/error.h"
#include "mesh/deck/editing/model_difference.h"

namespace prismesh::mesh::deck {

/// Errors: a shell of the deck has another part or thickness than its card; a shell or another element has a node that was removed.
Result<void> check_difference(const ModelDifference& difference);

}  // namespace prismesh::mesh::deck

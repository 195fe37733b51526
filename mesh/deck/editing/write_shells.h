// Writes the cards of shells that were added, removed or got other corners.
#pragma once

#include "base/error.h"
#include "mesh/deck/editing/card_progress.h"
#include "mesh/deck/editing/model_difference.h"
#include "mesh/deck/editing/text_edits.h"

namespace prismesh::mesh::deck {

/// Adds cards of reshaped shells, then cards of added shells, then removals to `edits`. Errors: a shell can't be written or removed safely
/// (file and line of the card that stands in the way, and the reason); cancelled.
Result<void> write_shells(const ModelDifference& difference, CardProgress& progress, TextEdits& edits);

}  // namespace prismesh::mesh::deck

// Writes the cards of added elements that are no shells, and of added parts.
#pragma once

#include "base/error.h"
#include "mesh/deck/editing/card_progress.h"
#include "mesh/deck/editing/model_difference.h"
#include "mesh/deck/editing/text_edits.h"

namespace prismesh::mesh::deck {

/// Adds cards behind those of their examples; without an example in a block behind all other cards of the main file, as the cards of added
/// parts. Errors: an element can't be written (with file and line of its example), cancelled.
Result<void> write_elements(const ModelDifference& difference, CardProgress& progress, TextEdits& edits);

}  // namespace prismesh::mesh::deck

// Changes the cards that name nodes and shells which an edit adds, divides or removes.
#pragma once

#include <cstddef>
#include <vector>

#include "base/error.h"
#include "mesh/deck/editing/model_difference.h"
#include "mesh/deck/editing/text_edits.h"

namespace prismesh::mesh::deck {

struct ReferenceChanges {
  std::vector<FileReplacement> replacements;
  std::size_t cards = 0;  ///< sets, segments and cards that change
};

/// Follows the rules in docs/formats/editing.md: sets that new nodes and shells join, copies of cards for them, segments on changed shells,
/// sets that removed ones leave. Errors: the rules forbid the edit, or the format can't write a change; with file and line of the card that
/// stands in the way.
Result<ReferenceChanges> reference_changes(const ModelDifference& difference);

}  // namespace prismesh::mesh::deck

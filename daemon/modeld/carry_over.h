// What a document is beyond its deck: the selection and the parts' states. After a save in place the new journal begins with it.
#pragma once

#include <vector>

#include "base/error.h"
#include "mesh/document/document.h"
#include "mesh/document/generation.h"
#include "mesh/document/journal.h"

namespace prismesh::modeld {

/// How many steps the functions below journal.
std::size_t steps_to_carry(const mesh::document::Generation& current);

/// Journals the steps that lead from `recorded` (freshly opened from the saved deck) to the same selection and part states as
/// `current`, and takes `recorded` there. Positions that the deck's columns couldn't hold to the last digit come along.
Result<void> carry_over(const mesh::document::Generation& current, mesh::document::Document& recorded, mesh::document::Journal& journal);

/// The same where `recorded` has other indices, since nodes or shells came or went: by ids. Positions are those of the saved deck.
Result<void> carry_over_by_ids(const mesh::document::Generation& current, mesh::document::Document& recorded,
                               mesh::document::Journal& journal);

}  // namespace prismesh::modeld

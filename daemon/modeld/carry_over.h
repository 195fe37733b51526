// Carries the selection and the part states over into the journal that a save in place begins.
#pragma once

#include <vector>

#include "base/error.h"
#include "mesh/document/document.h"
#include "mesh/document/generation.h"
#include "mesh/document/journal.h"

namespace prismesh::modeld {

/// Number of steps that the functions below add to the journal.
std::size_t steps_to_carry(const mesh::document::Generation& current);

/// Journals the steps that give `recorded`, freshly opened from the saved deck, the selection and part states of `current`, and applies
/// them to `recorded`. Node positions that the deck's columns rounded are carried over too. Errors: the journal can't be written.
Result<void> carry_over(const mesh::document::Generation& current, mesh::document::Document& recorded, mesh::document::Journal& journal);

/// The same, matched by ids, for a `recorded` whose indices differ because nodes or shells were added or removed. Positions are those of
/// the saved deck.
Result<void> carry_over_by_ids(const mesh::document::Generation& current, mesh::document::Document& recorded,
                               mesh::document::Journal& journal);

}  // namespace prismesh::modeld

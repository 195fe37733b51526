// Decides which cards name the nodes and shells that an edit adds, since they name those that the new ones come from.
#pragma once

#include "base/error.h"
#include "mesh/deck/editing/model_difference.h"
#include "mesh/deck/editing/reference_plan.h"

namespace prismesh::mesh::deck {

/// Adds to `plan` the sets that added nodes and shells join and the cards that are copied for them. Errors: a card that names all that a
/// new one comes from can't be passed on, or a range of ids catches a new one that doesn't belong to it (file and line).
Result<void> plan_inheritance(const ModelDifference& difference, const ShellFamilies& families, ReferencePlan& plan);

}  // namespace prismesh::mesh::deck

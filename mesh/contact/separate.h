// Moves shells that cross or are too close apart.
#pragma once

#include "base/error.h"
#include "base/progress.h"
#include "mesh/contact/separation.h"

namespace prismesh::mesh::contact {

/// Separates region by region, the perforations first, the deepest first. A region is removed whole, or left whole with the reason: nothing
/// new may cross or be too close, no shell more may fail or turn over, and no node goes farther than the piece of the
/// region that goes is deep (with the thickness and the gap, and 5 % of the target size). Method and limits: docs/contact.md. The same bits
/// whatever the number of threads. Errors: cancelled.
Result<Separation> separate(const SeparationInput& input, const SeparationWish& wish, const Progress& progress = {});

}  // namespace prismesh::mesh::contact

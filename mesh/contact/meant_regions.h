// Finds the regions that are to be separated. Private to mesh/contact.
#pragma once

#include <vector>

#include "mesh/contact/meant_region.h"
#include "mesh/contact/separation.h"
#include "mesh/contact/separation_check.h"

namespace prismesh::mesh::contact {

/// The regions among all of the model's that the wish means: perforations first, the deepest first; those that aren't to be tried have the
/// reason.
std::vector<MeantRegion> find_meant_regions(const SeparationInput& input, const SeparationWish& wish, const FoundContacts& found);

/// Makes the piece of a perforation the one that is pushed back.
void let_enter(const SeparationWish& wish, PerforationDepth depth, MeantRegion& region);

}  // namespace prismesh::mesh::contact

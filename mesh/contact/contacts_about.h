// What crosses and is too close about shells that moved, without a search of the whole model. Private to mesh/contact.
#pragma once

#include "mesh/contact/separation.h"
#include "mesh/contact/separation_check.h"

namespace prismesh::mesh::contact {

/// Finds in `after` what `find_contacts` finds there, but only those regions that may differ from `before`, and those with shells of
/// `about`. `moved`: the shells that differ. A region differs if a pair of its shells, before or after, has a shell that moved, or is so
/// near one that a path over the sheet may have changed. Both have their tree and the reach; what else they have isn't used. Costs these
/// regions.
FoundContacts find_contacts_about(const SeparationInput& input, const SeparationWish& wish, const SeparatedModel& before,
                                  const SeparatedModel& after, const ShellSet& moved, const ShellSet& about);

}  // namespace prismesh::mesh::contact

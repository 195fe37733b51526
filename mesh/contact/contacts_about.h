// What crosses and is too close about shells that moved, without a search of the whole model. Private to mesh/contact.
#pragma once

#include "mesh/contact/separation.h"
#include "mesh/contact/separation_check.h"

namespace prismesh::mesh::contact {

/// A state of a model, in which contacts are looked for. What it names must outlive it.
struct ContactState {
  const Model& model;  ///< with its adjacency
  const spatial::BoxTree& tree;
  const ContactThickness& thickness;
};
/// All shells of those regions that may differ between two states, and of those with shells of `about`. `changed`: the shells that differ,
/// or that only one state has. A region differs if a pair of its shells, before or after, has a shell that changed, or is so near one that
/// a path over the sheet may have changed. `reach`: shells farther apart aren't too close, wherever they are. Costs these regions.
ShellSet shells_of_changed_regions(const ContactState& before, const ContactState& after, double gap, double reach, const ShellSet& changed,
                                   const ShellSet& about);
/// The shells of a state that may be in one region with a shell of `whole`; ascending.
ShellSet shells_about(const ContactState& state, double reach, const ShellSet& whole);

/// Finds in `after` what `find_contacts` finds there, but only those regions that may differ from `before`, and those with shells of
/// `about`. `moved`: the shells that differ. Both have their tree and the reach; what else they have isn't used. Costs these regions.
FoundContacts find_contacts_about(const SeparationInput& input, const SeparationWish& wish, const SeparatedModel& before,
                                  const SeparatedModel& after, const ShellSet& moved, const ShellSet& about);

}  // namespace prismesh::mesh::contact

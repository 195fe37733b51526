// The ids of nodes and elements that keywords generate when the solver starts: they aren't in the model, but nothing new may have them.
// Source: Abaqus Keywords Guide, "*NGEN", "*NFILL", "*NCOPY", "*ELGEN", "*ELCOPY", "*ELEMENT", "*SYMMETRIC MODEL GENERATION".
#pragma once

#include "mesh/deck/abaqus/outline.h"
#include "mesh/deck/assembly/largest_ids.h"
#include "mesh/deck/data/taken_ids.h"

namespace prismesh::mesh::deck::abaqus {

/// Where the ids depend on sets, all that they could be count. Call it when the instances have their shifts. `largest`: with them.
TakenIds find_generated_ids(const DeckOutline& outline, LargestIds largest);

}  // namespace prismesh::mesh::deck::abaqus

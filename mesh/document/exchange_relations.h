// What edits need to know of a deck's nodes after a part got another mesh (deck_relations.h). Private to mesh/document.
#pragma once

#include <vector>

#include "mesh/document/dependents.h"
#include "mesh/document/generation.h"

namespace prismesh::mesh::document {

/// Gives `next` relations in which nodes that lay on shells that went or have other corners now lie on the nearest shells of the
/// same part, and cards
/// that join nodes have the nodes that are there. Returns those that lie on
/// no sheet of their part any more, as they were. Costs the relations, and the
/// part if there are such nodes. Precondition: the model of `next` has its adjacency.
std::vector<NodeOnSheet> exchange_relations(const Model& before, Generation& next);

}  // namespace prismesh::mesh::document

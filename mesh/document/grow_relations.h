// What edits need to know of elements that an edit adds (deck_relations.h). Private to mesh/document.
#pragma once

#include "mesh/document/generation.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::document {

/// Gives `next` relations with the elements that it has and `before` hasn't: their uses of nodes, and those of their nodes that lie on
/// sheets. Costs the relations, and the shells of the model if there are such elements. Precondition: the model of `next` has its
/// adjacency.
void grow_relations(const Model& before, Generation& next);

/// Finds anew on which sheets those of the nodes lie that belong to welds. `moved` ascending; their places in `next` are others than
/// before. Costs the elements, and the shells of the model if there are such nodes.
void place_anew(const NodeSet& moved, Generation& next);

}  // namespace prismesh::mesh::document

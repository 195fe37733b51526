// The shells that differ between two states of a model. Private to mesh/contact.
#pragma once

#include "mesh/model/model.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::contact {

/// The shells whose corners or their places differ, or that only one of the models has; ascending. Costs the chunks that differ.
/// Preconditions: shells and nodes that both have keep their index; both have their adjacency.
ShellSet changed_shells(const Model& before, const Model& after);

}  // namespace prismesh::mesh::contact

// Mid-side nodes and the ends of their edges: what moves with an end. Private to mesh/document.
#pragma once

#include <array>
#include <vector>

#include "mesh/model/model.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::document {

struct EdgeMiddle {
  NodeIndex node;
  std::array<NodeIndex, 2> end;
};

/// The mid-side nodes of `shells` on edges with an end among `nodes`, or among these themselves, with the ends of their edges; ascending,
/// each once. A node that is a corner elsewhere moves as one and isn't among them. Both sets ascending.
std::vector<EdgeMiddle> middles_in(const Model& model, const NodeSet& nodes, const ShellSet& shells);

}  // namespace prismesh::mesh::document

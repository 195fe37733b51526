// Finds the mid-side nodes that move with the ends of their edges. Private to mesh/document.
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

/// The mid-side nodes of `shells` that are among `nodes`, or on an edge with an end among them; ascending, each once. A node that is also a
/// corner of a shell moves as a corner and isn't included. Both sets ascending.
std::vector<EdgeMiddle> middles_in(const Model& model, const NodeSet& nodes, const ShellSet& shells);

}  // namespace prismesh::mesh::document

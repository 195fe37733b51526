// Sets of nodes or shells as ascending indices: small, cheap to send, the same whatever made them.
#pragma once

#include <vector>

#include "mesh/model/index.h"

namespace prismesh::mesh {

using NodeSet = std::vector<NodeIndex>;    ///< ascending, each once
using ShellSet = std::vector<ShellIndex>;  ///< ascending, each once

struct Model;

/// Returns the shells with at least one node in the set / with all nodes in the set.
ShellSet shells_touching(const Model& model, const NodeSet& nodes);
ShellSet shells_inside(const Model& model, const NodeSet& nodes);
/// Returns the corner and mid-side nodes of the shells.
NodeSet nodes_of(const Model& model, const ShellSet& shells);

}  // namespace prismesh::mesh

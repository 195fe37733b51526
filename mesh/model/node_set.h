// A set of nodes or shells as ascending indices: small, cheap to send, the same whatever made it.
#pragma once

#include <vector>

#include "mesh/model/index.h"

namespace prismesh::mesh {

using NodeSet = std::vector<NodeIndex>;    ///< ascending, each once
using ShellSet = std::vector<ShellIndex>;  ///< ascending, each once

struct Model;

/// Shells with at least one node of the set / with all their nodes in the set.
ShellSet shells_touching(const Model& model, const NodeSet& nodes);
ShellSet shells_inside(const Model& model, const NodeSet& nodes);
/// Corner and mid-side nodes of the shells.
NodeSet nodes_of(const Model& model, const ShellSet& shells);

}  // namespace prismesh::mesh

// Finds the shells that a motion turns over or folds. Private to mesh/document.
#pragma once

#include <vector>

#include "mesh/document/motion.h"
#include "mesh/model/model.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::document {

/// Shells whose normal turned by more than 90 degrees (beyond what a rotation by `degrees` turns it), or of which a corner's Jacobian is no
/// longer greater than 0. `shells` are those that touch moved nodes.
std::vector<ShellIndex> inverted_shells(const Model& before, const Model& after, const ShellSet& shells, const Motion& motion,
                                        double degrees);

}  // namespace prismesh::mesh::document

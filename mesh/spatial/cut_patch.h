// Cuts patches out of a model, with what marching needs of their shape.
#pragma once

#include "mesh/model/model.h"
#include "mesh/model/node_set.h"
#include "mesh/spatial/patch.h"

namespace prismesh::mesh::spatial {

/// The patch of all given shells.
Patch cut_patch(const Model& model, const ShellSet& shells);

/// The patch between the given nodes: its local nodes are exactly those, also the ones no shell touches. Of a shell with only
/// some corners among them, the triangle or the line between those remains, so that a chain of nodes is still a way.
Patch cut_patch_between(const Model& model, const NodeSet& nodes);

}  // namespace prismesh::mesh::spatial

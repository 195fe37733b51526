// Cuts patches out of a model, with the geometry that fast marching uses.
#pragma once

#include "mesh/model/model.h"
#include "mesh/model/node_set.h"
#include "mesh/spatial/patch.h"

namespace prismesh::mesh::spatial {

/// Cuts out the given shells.
Patch cut_patch(const Model& model, const ShellSet& shells);

/// Cuts out what lies between the given nodes. The local nodes are exactly those, also the ones that no shell touches. Of a shell with only
/// some corners among them, the triangle or the line between those remains, so that distances also follow a chain of nodes.
Patch cut_patch_between(const Model& model, const NodeSet& nodes);

}  // namespace prismesh::mesh::spatial

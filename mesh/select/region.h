// Selections that follow the surface: a region bounded by feature edges, rings of neighbours, what lies inside an outline.
#pragma once

#include <vector>

#include "mesh/model/model.h"
#include "mesh/model/node_set.h"
#include "mesh/select/outline.h"

namespace prismesh::mesh::select {

/// Shells reachable from the shells at `start` without crossing a crease sharper than `angle_degrees`, a free edge or a
/// junction of three or more shells.
ShellSet region(const Model& model, NodeIndex start, double angle_degrees);

/// The node nearest to a point.
NodeIndex nearest_node(const Model& model, const Vec3& point);

/// One ring of neighbours more / the rim nodes less, `rings` times.
NodeSet grow(const Model& model, const NodeSet& nodes, int rings);
NodeSet shrink(const Model& model, const NodeSet& nodes, int rings);
NodeSet invert(const Model& model, const NodeSet& nodes);

}  // namespace prismesh::mesh::select

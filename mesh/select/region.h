// Selections that follow the surface: a region bounded by feature edges, rings of neighbours, what lies inside an outline.
#pragma once

#include <array>
#include <vector>

#include "mesh/model/model.h"
#include "mesh/model/node_set.h"

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

/// Nodes whose projection lies inside the closed outline. `view` takes deck coordinates to clip space (column-major 4x4);
/// `outline` is in normalised device coordinates. Nodes behind the eye are outside.
NodeSet inside_outline(const Model& model, const std::array<double, 16>& view, const std::vector<std::array<double, 2>>& outline);

}  // namespace prismesh::mesh::select

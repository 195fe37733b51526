// Selects the nodes inside an outline drawn on the screen.
#pragma once

#include <array>
#include <vector>

#include "mesh/model/model.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::select {

/// Returns the nodes whose projection lies inside the closed outline: its winding number isn't 0. `view` maps deck coordinates to clip
/// space (column-major 4x4). `outline` is in normalised device coordinates and may reach beyond -1..1. Nodes behind the eye are outside. A
/// node exactly on the border is inside if the border is on its left or below it. Empty for fewer than three points and for coordinates
/// that aren't finite. Cost: a pass over the nodes, and for each node the sides of the outline at its height.
NodeSet inside_outline(const Model& model, const std::array<double, 16>& view, const std::vector<std::array<double, 2>>& outline);

}  // namespace prismesh::mesh::select

// How far many points lie from a surface.
#pragma once

#include <span>
#include <vector>

#include "base/progress.h"
#include "mesh/spatial/closest_point.h"

namespace prismesh::mesh::spatial {

/// Distance of each point from the tree's surface, deck's length unit; NaN for a point that isn't finite, and for all if the tree is empty.
/// On all cores, along a curve through space on which each point begins where the one before it ended. The same bits whatever the number of
/// cores. Errors: cancelled.
Result<std::vector<double>> distances_to(const ShellTree& tree, std::span<const Vec3> points, const Progress& progress = {});

}  // namespace prismesh::mesh::spatial

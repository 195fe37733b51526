// Computes the distances of many points from a surface.
#pragma once

#include <span>
#include <vector>

#include "base/progress.h"
#include "mesh/spatial/closest_point.h"

namespace prismesh::mesh::spatial {

/// Returns the distance of each point from the tree's surface, in the deck's length unit; NaN for a point that isn't finite, and for all
/// points if the tree is empty. Works on all cores. The points are visited along a space-filling curve, and each search starts at the
/// result of the one before it. The same bits whatever the number of cores. Errors: cancelled.
Result<std::vector<double>> distances_to(const ShellTree& tree, std::span<const Vec3> points, const Progress& progress = {});

}  // namespace prismesh::mesh::spatial

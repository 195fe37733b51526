// Moves selected nodes: computes the position of each for a displacement of the grab.
#pragma once

#include <span>
#include <vector>

#include "mesh/shape/weights.h"

namespace prismesh::mesh::shape {

/// Computes the positions after a translation of the grab by `by`. `start` (positions before the drag), `weight` and `out` have one entry
/// for each node.
void translate(std::span<const Vec3> start, std::span<const double> weight, const Vec3& by, std::span<Vec3> out);

/// Computes the positions after a lift by `distance` along `normals` (one for each node, or one for all).
void lift(std::span<const Vec3> start, std::span<const double> weight, std::span<const Vec3> normals, double distance, std::span<Vec3> out);

}  // namespace prismesh::mesh::shape

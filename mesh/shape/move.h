// Moving selected nodes: where each one goes for a given displacement of the grab.
#pragma once

#include <span>
#include <vector>

#include "mesh/shape/weights.h"

namespace prismesh::mesh::shape {

/// New positions of weights.nodes for a translation of the grab by `by`; from `start` (positions before the drag).
void translate(std::span<const Vec3> start, std::span<const double> weight, const Vec3& by, std::span<Vec3> out);

/// New positions for a lift by `distance` along `normals` (one each, or one for all).
void lift(std::span<const Vec3> start, std::span<const double> weight, std::span<const Vec3> normals, double distance, std::span<Vec3> out);

}  // namespace prismesh::mesh::shape

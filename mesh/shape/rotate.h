// Turns selected nodes about an axis: every node moves on its own circle.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "mesh/model/model.h"
#include "mesh/shape/axis.h"

namespace prismesh::mesh::shape {

/// The unit vector of a direction, also of very long and very short ones. Nothing for zero and for what isn't finite.
std::optional<Vec3> unit_of(const Vec3& direction);

/// Computes the positions after a turn: node i turns by weight[i] of the angle. `start`, `weight` and `out` have one entry for each node. A
/// node's distance from the axis stays, and nodes of equal weight keep their distances from each other. With `max_move` a node stops on its
/// circle where it is that far from its start. Returns how many nodes stopped. For an angle of 1e9 degrees or more all positions are NaN.
std::size_t rotate(std::span<const Vec3> start, std::span<const double> weight, const Rotation& rotation, std::span<Vec3> out);

}  // namespace prismesh::mesh::shape

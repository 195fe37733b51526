// Turning selected nodes about an axis: every node on its own circle.
#pragma once

#include <optional>
#include <span>

#include "mesh/model/model.h"

namespace prismesh::mesh::shape {

struct Axis {
  Vec3 point = Vec3::Zero();      ///< any point on it
  Vec3 direction = Vec3::Zero();  ///< of length 1
};

/// A direction's unit vector, also of very long and very short ones; nothing for zero and for what isn't finite.
std::optional<Vec3> unit_of(const Vec3& direction);

/// New positions for a turn by `degrees`, right-handed: node i by weight[i] of it. `start`, `weight` and `out` have one entry each. A
/// node's distance from the axis stays, and nodes of equal weight keep their distances from each other. With `max_move` a node stops on its
/// circle where it is that far from its start. Returns how many stopped. No finite coordinates come of an angle of 1e9 degrees or more.
std::size_t rotate(std::span<const Vec3> start, std::span<const double> weight, const Axis& axis, double degrees,
                   std::optional<double> max_move, std::span<Vec3> out);

}  // namespace prismesh::mesh::shape

// Measures between nodes: distances, angles, radii, and lengths along the surface.
#pragma once

#include <optional>
#include <span>

#include "mesh/model/in_sight.h"
#include "mesh/model/model.h"

namespace prismesh::mesh::measure {

/// The circle through three points. Lengths are in the deck's unit.
struct Circle {
  Vec3 centre = Vec3::Zero();
  double radius = 0;
  Vec3 normal = Vec3::UnitZ();  ///< of length 1; from it the points go round counterclockwise
};

/// At b, from 0 to 180 degrees; absent where b lies on a or c.
std::optional<double> angle_degrees(const Vec3& a, const Vec3& b, const Vec3& c);

/// Absent where the points lie on a line: where the farthest from the line through the two others is nearer to it than a 10^-9 of their
/// distance.
std::optional<Circle> circle_through(const Vec3& a, const Vec3& b, const Vec3& c);

/// The length of the shortest way from node to node along visible shells that share nodes, by fast marching (mesh/spatial/geodesic.h):
/// exact but for rounding on surfaces that unroll into a plane. Absent where no such way exists. Costs the shells in a ball about `a` that
/// is at most twice as large as needed, and a look at each shell for each doubling. Precondition: the nodes exist.
std::optional<double> length_along_surface(const Model& model, NodeIndex a, NodeIndex b, OutOfSight out_of_sight = {});

/// What two or three nodes say about each other.
struct NodeMeasures {
  Vec3 between = Vec3::Zero();  ///< from the first node to the last
  double distance = 0;          ///< of the first and the last
  std::optional<double> along_surface;
  // of three nodes
  std::optional<double> angle;  ///< at the second, in degrees
  std::optional<Circle> circle;
};

/// Precondition: two or three nodes that exist.
NodeMeasures measure_nodes(const Model& model, std::span<const NodeIndex> nodes, OutOfSight out_of_sight = {});

}  // namespace prismesh::mesh::measure

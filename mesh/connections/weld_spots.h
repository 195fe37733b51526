// Where spot welds go: spots along a line, and the sheets that lie on each other at a spot. Rules: docs/welds.md.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "mesh/model/model.h"
#include "mesh/spatial/box_tree.h"

namespace prismesh::mesh::connections {

/// Lengths are in the deck's unit.
struct SpotSpacing {
  double pitch = 0;         ///< above 0; the spots are as far apart as this, but for less than half of it shared among them
  double end_distance = 0;  ///< of the first and the last spot from the ends of a line that isn't closed; at most half its length
};

/// The length of a line through points.
double length_of(std::span<const Vec3> line);

/// Spots along a line, evenly spaced: the first and the last are at the end distance, the others between them; a line too short for two has
/// one in its middle. On a closed line, whose last point is its first, they go around. Precondition: the line has a length.
std::vector<Vec3> spots_along(std::span<const Vec3> line, bool closed, const SpotSpacing& spacing);

/// The distance of a point from a line.
double distance_to(std::span<const Vec3> line, const Vec3& point);

/// A sheet at a spot.
struct SheetAtSpot {
  ShellIndex shell;
  Vec3 point = Vec3::Zero();  ///< where the line through the spot, normal to the nearest sheet, goes through it
};

/// The sheets that lie on each other at a spot, from one face of the stack to the other.
struct SpotStack {
  std::vector<SheetAtSpot> sheets;
  std::optional<double> nearest;  ///< the distance of the nearest sheet, of any at all, if no sheet is within reach
};

struct SpotOptions {
  double thickness_factor = 2;  ///< as FlangeOptions
  double gap = 0;
};

/// The stack at a place: the nearest sheet within reach of it (what is placed on it, and the gap), and from there up and down the sheets
/// that are near enough and parallel, by the rules of flanges. Nothing in `sheets` if none is within reach.
/// `tree`: of the model, without the shells that don't count.
SpotStack stack_at(const Model& model, const spatial::BoxTree& tree, const Vec3& place, const SpotOptions& options);

}  // namespace prismesh::mesh::connections

// Chooses the clusters that a view draws.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/lod/levels.h"

namespace prismesh::mesh::lod {

/// How large things appear.
struct Viewpoint {
  Vec3 eye = Vec3::Zero();          ///< model's coordinates
  double pixels_at_distance_1 = 0;  ///< size in pixels of a length of 1 at the distance 1
  double nearest = 0;               ///< what is nearer counts as at this distance
  /// What the distance grows by along each axis, if it is counted along the view, in any unit, and 0 at the eye; zero: it is the length of
  /// the way from the eye. Drawing with compressed depth needs the first: there things are nearer than their place says.
  Vec3 away = Vec3::Zero();
};

/// What coarse triangles may stand for.
struct Limits {
  double error_pixels = 1;                                       ///< they are no farther from their shells
  double side_pixels = std::numeric_limits<double>::infinity();  ///< of the shells: larger ones are seen as they are
};

/// Appends the indices of the clusters, ascending: together they stand for each shell exactly once, within the limits as seen from `from`.
/// `moved`: by how much nodes under a group have moved (added_errors); empty: not at all.
void choose(const Levels& levels, std::span<const float> moved, const Viewpoint& from, const Limits& limits,
            std::vector<std::uint32_t>& clusters);

/// How many shells, and triangles of coarse clusters, they have; a quad counts as two triangles.
std::size_t triangles_of(const Levels& levels, std::span<const std::uint32_t> clusters);

}  // namespace prismesh::mesh::lod

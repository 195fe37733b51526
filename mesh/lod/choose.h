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
};

/// Appends the indices of the clusters, ascending: together they stand for each shell exactly once, and none is farther from its shells
/// than `max_pixels` as seen from `from`. `held`: groups that aren't chosen (groups_over); empty: none.
void choose(const Levels& levels, const std::vector<std::uint8_t>& held, const Viewpoint& from, double max_pixels,
            std::vector<std::uint32_t>& clusters);

/// How many shells, and triangles of coarse clusters, they have; a quad counts as two triangles.
std::size_t triangles_of(const Levels& levels, std::span<const std::uint32_t> clusters);

}  // namespace prismesh::mesh::lod

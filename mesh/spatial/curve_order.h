// An order of points that follows space.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/model/model.h"

namespace prismesh::mesh::spatial {

/// Sorts the finite points along a space-filling curve [Morton 1966], so that neighbours in the list are near each other. Returns their
/// indices; points that aren't finite are left out. Where the extent is 0 or too large for a double, the points keep their order. `shift`
/// (0 to 1): moves the cells of the curve by this share of the extent, so that other points are neighbours in the list.
std::vector<std::uint32_t> along_curve(std::span<const Vec3> points, double shift = 0);

}  // namespace prismesh::mesh::spatial

// Distance along the surface: fast marching over quads and triangles.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "mesh/spatial/patch.h"

namespace prismesh::mesh::spatial {

inline constexpr double kUnreached = std::numeric_limits<double>::infinity();

/// Distance of each local node from the nearest source along the patch's surface, kUnreached where there is no way or it
/// is longer than `radius`. Multi-source fast marching on the triangles of both diagonals of each quad; obtuse corners are
/// unfolded (Kimmel & Sethian 1998). Where the wave comes from one source its centre is unfolded into each triangle
/// (Novotni & Klein 2002), so on surfaces that unroll into a plane the result is exact but for rounding; between waves of
/// different sources it counts as plane, and where two waves of one source meet behind turns both go on. Sources out of range are ignored.
/// The same bits on every processor.
std::vector<double> geodesic_distance(const Patch& patch, std::span<const std::uint32_t> sources, double radius = kUnreached);

}  // namespace prismesh::mesh::spatial

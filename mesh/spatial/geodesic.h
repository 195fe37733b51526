// Computes distances along the surface by fast marching over quads and triangles.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "mesh/spatial/patch.h"

namespace prismesh::mesh::spatial {

inline constexpr double kUnreached = std::numeric_limits<double>::infinity();

/// Returns the distance of each local node from the nearest source along the patch's surface, in the deck's length unit; kUnreached where
/// no path exists or it is longer than `radius`. Sources are local nodes; those out of range are ignored. The same bits on every processor.
/// Method: fast marching from all sources at once, on the triangles of both diagonals of each quad; obtuse corners are unfolded
/// [Kimmel 1998]. Where the wave at both ends of a triangle's base has one centre, the centre is unfolded into the triangle's plane
/// [Novotni 2002], so the result is exact but for rounding on surfaces that unroll into a plane. Between waves of different sources the
/// front counts as straight. Where two waves of one source meet behind a turn, both are continued.
std::vector<double> geodesic_distance(const Patch& patch, std::span<const std::uint32_t> sources, double radius = kUnreached);

/// The same from sources that have a distance of their own already: the sum of both counts. `start` has one entry for each source.
std::vector<double> geodesic_distance_from(const Patch& patch, std::span<const std::uint32_t> sources, std::span<const double> start);

}  // namespace prismesh::mesh::spatial

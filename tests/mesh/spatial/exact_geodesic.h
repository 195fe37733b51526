// Exact distances over a surface of triangles: the oracle that judges the marching. It shares no code with it.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace prismesh::test {

/// Any number of triangles may meet at an edge.
struct TriangleSurface {
  std::vector<Eigen::Vector3d> point;
  std::vector<std::array<std::uint32_t, 3>> triangle;
};

/// Length of the shortest path over the surface from the nearest source to each point, up to rounding; infinity where there is none or
/// it is longer than `radius`. Windows of straight paths are carried from triangle to triangle, nearest first (Mitchell, Mount,
/// Papadimitriou 1987; Chen & Han 1990; Xin & Wang 2009); paths turn at the points of boundaries, junctions and saddles.
std::vector<double> exact_geodesic(const TriangleSurface& surface, std::span<const std::uint32_t> sources,
                                   double radius = std::numeric_limits<double>::infinity());

}  // namespace prismesh::test

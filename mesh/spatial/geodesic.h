// Distance along the surface: fast marching over quads and triangles.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "mesh/model/adjacency.h"
#include "mesh/model/model.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::spatial {

/// A patch of surface with nodes numbered 0..n-1, cut out of a model so that repeated solves touch only it.
struct Patch {
  NodeSet nodes;                                     ///< local -> model
  std::vector<std::array<std::uint32_t, 4>> shells;  ///< local corners; a triangle repeats its third
  ShellSet shell_of;                                 ///< model shell of each local shell
  std::vector<Vec3> positions;                       ///< of `nodes`
  std::vector<std::uint32_t> node_first;             ///< CSR local node -> local shells
  std::vector<std::uint32_t> node_shells;
};

/// The patch of all given shells.
Patch cut_patch(const Model& model, const ShellSet& shells);

inline constexpr double kUnreached = std::numeric_limits<double>::infinity();

/// Distance of each local node from the nearest source along the patch's surface, kUnreached where there is no way or it
/// is longer than `radius`. Multi-source fast marching on the triangles of both diagonals of each quad; obtuse corners are
/// unfolded (Kimmel & Sethian 1998). Exact on straight lines from a source within its own shells.
std::vector<double> geodesic_distance(const Patch& patch, std::span<const std::uint32_t> sources, double radius = kUnreached);

}  // namespace prismesh::mesh::spatial

// Distance along the surface: fast marching over quads and triangles.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "mesh/model/adjacency.h"
#include "mesh/model/model.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::spatial {

/// A triangle that isn't in the mesh: the far side of an obtuse corner, unfolded until a node lies in front of the corner.
struct UnfoldedTriangle {
  std::array<std::uint32_t, 2> support;  ///< local nodes the distance comes from
  std::uint32_t target = 0;              ///< local node it goes to
  double base = 0;                       ///< between the supports
  std::array<double, 2> side{};          ///< from each support to the target
};

/// A patch of surface with nodes numbered 0..n-1, cut out of a model so that repeated solves touch only it.
struct Patch {
  NodeSet nodes;                                     ///< local -> model
  std::vector<std::array<std::uint32_t, 4>> shells;  ///< distinct local corners, the last one repeated: a triangle, a line
  ShellSet shell_of;                                 ///< model shell of each local shell
  std::vector<Vec3> positions;                       ///< of `nodes`
  std::vector<std::uint32_t> node_first;             ///< CSR local node -> local shells
  std::vector<std::uint32_t> node_shells;
  std::vector<std::uint8_t> rim;  ///< cut_patch_between: 1 where a shell of the model reaches outside the patch's nodes

  // What marching needs of the patch's shape, whatever the sources.
  std::vector<std::array<double, 6>> lengths;  ///< of each shell's sides 01 12 23 30 and diagonals 02 13
  std::vector<std::uint8_t> bends;             ///< 1 where a shortest way can turn: a boundary's reflex corner
  std::vector<UnfoldedTriangle> unfolded;      ///< of obtuse corners
  std::vector<std::uint32_t> unfolded_first;   ///< CSR local node -> unfolded triangles it supports
  std::vector<std::uint32_t> unfolded_of;
};

/// The patch of all given shells.
Patch cut_patch(const Model& model, const ShellSet& shells);

/// The patch between the given nodes: its local nodes are exactly those, also the ones no shell touches. Of a shell with only
/// some corners among them, the triangle or the line between those remains, so that a chain of nodes is still a way.
Patch cut_patch_between(const Model& model, const NodeSet& nodes);

inline constexpr double kUnreached = std::numeric_limits<double>::infinity();

/// Distance of each local node from the nearest source along the patch's surface, kUnreached where there is no way or it
/// is longer than `radius`. Multi-source fast marching on the triangles of both diagonals of each quad; obtuse corners are
/// unfolded (Kimmel & Sethian 1998). Where the wave comes from one source its centre is unfolded into each triangle
/// (Novotni & Klein 2002), so on surfaces that unroll into a plane the result is exact but for rounding; between waves of
/// different sources it counts as plane, and where two waves of one source meet behind turns both go on. Sources out of range are ignored.
/// The same bits on every processor.
std::vector<double> geodesic_distance(const Patch& patch, std::span<const std::uint32_t> sources, double radius = kUnreached);

}  // namespace prismesh::mesh::spatial

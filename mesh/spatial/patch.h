// A patch of surface cut out of a model, so that repeated solves touch only it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesh/model/model.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::spatial {

/// A triangle that isn't in the mesh: it makes up for an obtuse corner (mesh/spatial/unfold.h).
struct UnfoldedTriangle {
  std::array<std::uint32_t, 2> support;  ///< local nodes from which a distance is computed
  std::uint32_t target = 0;              ///< local node at which it is computed: the obtuse corner
  double base = 0;                       ///< between the supports
  std::array<double, 2> side{};          ///< from each support to the target
};

/// Nodes are numbered 0..n-1.
struct Patch {
  NodeSet nodes;                                     ///< local -> model
  std::vector<std::array<std::uint32_t, 4>> shells;  ///< distinct local corners, the last one repeated: a triangle, a line
  ShellSet shell_of;                                 ///< model shell of each local shell
  std::vector<Vec3> positions;                       ///< of `nodes`
  std::vector<std::uint32_t> node_first;             ///< CSR local node -> local shells
  std::vector<std::uint32_t> node_shells;
  std::vector<std::uint8_t> rim;  ///< cut_patch_between: 1 where a shell of the model reaches outside the patch's nodes

  // geometry that fast marching uses, independent of the sources
  std::vector<std::array<double, 6>> lengths;  ///< of each shell's sides 01 12 23 30 and diagonals 02 13
  std::vector<std::uint8_t> bends;             ///< 1 where a shortest path can turn: at a reflex corner of the boundary
  std::vector<UnfoldedTriangle> unfolded;      ///< of obtuse corners
  std::vector<std::uint32_t> unfolded_first;   ///< CSR local node -> unfolded triangles it supports
  std::vector<std::uint32_t> unfolded_of;
};

/// How many of a local shell's corners are distinct: 4, 3, or 2 for a line.
inline int corner_count(const std::array<std::uint32_t, 4>& corner) {
  if (corner[1] == corner[0]) return 1;
  if (corner[2] == corner[1]) return 2;
  return corner[3] == corner[2] ? 3 : 4;
}

}  // namespace prismesh::mesh::spatial

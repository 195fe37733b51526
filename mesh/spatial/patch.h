// A patch of surface cut out of a model, so that repeated solves touch only it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

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

/// Nodes are numbered 0..n-1.
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

/// How many of a local shell's corners are distinct: 4, 3, or 2 for a line.
inline int corner_count(const std::array<std::uint32_t, 4>& corner) {
  if (corner[1] == corner[0]) return 1;
  if (corner[2] == corner[1]) return 2;
  return corner[3] == corner[2] ? 3 : 4;
}

}  // namespace prismesh::mesh::spatial

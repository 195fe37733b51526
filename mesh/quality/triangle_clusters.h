// Nodes with more triangles about them than allowed: many triangles together are stiff. Definition: docs/quality/structure.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mesh/model/model.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::quality {

/// A cluster of triangles: a node with too many about it.
struct TriangleCluster {
  NodeIndex node;
  std::size_t triangles = 0;  ///< about the node, without those of meshes of triangles
  ShellIndex shell;           ///< the first of them
  std::uint8_t corner = 0;    ///< of that shell, at the node
  bool operator==(const TriangleCluster&) const = default;
};
using TriangleClusters = std::vector<TriangleCluster>;  ///< ascending by node

/// Tells by PartIndex which parts are meshes of triangles, whose triangles are meant and never form a cluster: at least three of four
/// shells are triangles. The last entry is for shells without a part.
std::vector<std::uint8_t> meshes_of_triangles(const Model& model);

/// Finds the nodes with more than `allowed` of the given triangles (nullptr: all), without those of meshes of triangles. Costs one pass
/// over the model's shells.
TriangleClusters find_triangle_clusters(const Model& model, double allowed, const ShellSet* shells = nullptr);

}  // namespace prismesh::mesh::quality

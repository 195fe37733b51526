// Faults in how shells are joined, which no metric of a single shell shows. Definitions: docs/quality/structure.md.
#pragma once

#include <vector>

#include "mesh/model/adjacency.h"
#include "mesh/model/model.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::quality {

/// Every list ascends. Edges are those of the model's adjacency.
struct Structure {
  ShellSet duplicates;                 ///< shells with the same corners as an earlier shell, in any order
  std::vector<EdgeIndex> opposed;      ///< of two shells whose normals aren't aligned: both have the edge in the same direction
  std::vector<EdgeIndex> multiple;     ///< of three shells or more
  std::vector<EdgeIndex> unjoined;     ///< free, with another free edge of the part at the same place
  std::vector<EdgeIndex> free_inside;  ///< on a small loop of free edges inside a part, as around a missing shell; without unjoined ones
  NodeSet clusters;                    ///< nodes with more triangles than allowed (mesh/quality/triangle_clusters.h)
  std::size_t max_triangles = 0;       ///< max number of triangles at a node
  NodeIndex max_triangles_at;          ///< the first node with so many; invalid without triangles
};

struct StructureOptions {
  double triangles_at_node = 3;  ///< max triangles at a node; more are a cluster
  double tolerance = 0.01;       ///< max distance of free edges at the same place, as a fraction of their length
};

/// Checks how the given shells (nullptr: all) are joined to any shell. Precondition: the model has its adjacency. Deterministic, whatever
/// the number of threads. Source: the checks of commercial pre-processors.
Structure check_structure(const Model& model, const StructureOptions& options = {}, const ShellSet* shells = nullptr);

}  // namespace prismesh::mesh::quality

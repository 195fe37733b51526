// What is wrong with how shells are joined, which no metric of one shell shows. Definitions: docs/quality/structure.md.
#pragma once

#include <vector>

#include "mesh/model/adjacency.h"
#include "mesh/model/model.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::quality {

/// Every list ascends. Edges are those of the model's adjacency.
struct Structure {
  ShellSet duplicates;                 ///< shells whose corners an earlier shell has too, in whatever order
  std::vector<EdgeIndex> opposed;      ///< two shells share it and their normals aren't aligned: both run along it the same way
  std::vector<EdgeIndex> multiple;     ///< three shells or more
  std::vector<EdgeIndex> unjoined;     ///< free, though another free edge of the part lies at the same place
  std::vector<EdgeIndex> free_inside;  ///< on a small loop of free edges inside a part, as a missing shell leaves; without unjoined ones
  NodeSet clusters;                    ///< nodes with more triangles about them than allowed
  std::size_t most_triangles = 0;      ///< about one node
  NodeIndex most_triangles_at;         ///< the first such node; invalid without triangles
};

struct StructureOptions {
  std::size_t triangles_at_node = 3;  ///< more about a node are a cluster
  double tolerance = 0.01;            ///< how near free edges are at the same place, as a fraction of their length
};

/// Looks at the shells given (all: nullptr) and how they are joined to any. Precondition: the model has its adjacency. Deterministic,
/// whatever the number of threads. Source of what is looked for: what commercial pre-processors check.
Structure check_structure(const Model& model, const StructureOptions& options = {}, const ShellSet* shells = nullptr);

}  // namespace prismesh::mesh::quality

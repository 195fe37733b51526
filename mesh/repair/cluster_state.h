// What a repair knows about clusters of triangles: nodes with too many about them.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/model/node_set.h"
#include "mesh/repair/patch.h"

namespace prismesh::mesh::repair {

struct ClusterState {
  double allowed = 0;                            ///< max triangles at a node
  std::vector<std::uint8_t> meant;               ///< quality::meshes_of_triangles of the model: their triangles don't count
  NodeSet in_scope;                              ///< nodes of the model, ascending
  std::map<LocalNode, std::string_view> reason;  ///< why a node keeps its triangles
};

/// A cluster that is left.
struct ClusterLeft {
  NodeIndex node;             ///< invalid: a new node
  std::size_t triangles = 0;  ///< about it
  std::string why;
};

}  // namespace prismesh::mesh::repair

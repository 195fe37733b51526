// What a repair changes in a model's shells and nodes, as its net result: whoever owns the model carries it out (ids and cards aren't known
// here).
#pragma once

#include <utility>
#include <vector>

#include "mesh/model/model.h"
#include "mesh/model/node_set.h"
#include "mesh/model/topology_change.h"

namespace prismesh::mesh::repair {

struct NewNode {
  Vec3 position = Vec3::Zero();
  NodeOrigin origin;  ///< parents may be new nodes that stand before it
};
struct NewShell {
  ShellNodes nodes;   ///< may be new nodes
  ShellIndex parent;  ///< of the model: what it takes part, thickness and the rest of its card from
};

/// Nothing is named twice; what comes and goes again isn't in it.
struct Restructuring {
  std::vector<NewNode> new_nodes;                           ///< number i gets the index node_count() + i
  std::vector<NewShell> new_shells;                         ///< number i gets the index shell_count() + i
  std::vector<std::pair<ShellIndex, ShellNodes>> reshaped;  ///< ascending
  ShellSet removed_shells;
  NodeSet removed_nodes;                          ///< of no shell any more, and no other element or card has them
  std::vector<std::pair<NodeIndex, Vec3>> moved;  ///< ascending; nodes of the model that stay

  bool empty() const { return new_nodes.empty() && new_shells.empty() && reshaped.empty() && removed_shells.empty() && moved.empty(); }
};

}  // namespace prismesh::mesh::repair

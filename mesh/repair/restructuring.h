// The change that a repair makes to a model's shells and nodes. The model's owner applies it, since it gives ids and writes cards.
#pragma once

#include <utility>
#include <vector>

#include "mesh/model/model.h"
#include "mesh/model/node_set.h"
#include "mesh/model/topology_change.h"

namespace prismesh::mesh::repair {

struct NewNode {
  Vec3 position = Vec3::Zero();
  NodeOrigin origin;  ///< parents may be earlier new nodes
};
struct NewShell {
  ShellNodes nodes;   ///< new nodes among them by the index that they get
  ShellIndex parent;  ///< of the model: gives part, thickness and the rest of the card
};

/// Names each node and shell once; one that was made and removed again isn't in it.
struct Restructuring {
  std::vector<NewNode> new_nodes;                           ///< number i gets the index node_count() + i
  std::vector<NewShell> new_shells;                         ///< number i gets the index shell_count() + i
  std::vector<std::pair<ShellIndex, ShellNodes>> reshaped;  ///< ascending
  ShellSet removed_shells;
  NodeSet removed_nodes;                          ///< that no shell, other element or card has any more
  std::vector<std::pair<NodeIndex, Vec3>> moved;  ///< ascending; nodes of the model that stay

  bool empty() const { return new_nodes.empty() && new_shells.empty() && reshaped.empty() && removed_shells.empty() && moved.empty(); }
};

}  // namespace prismesh::mesh::repair

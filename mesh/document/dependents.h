// What depends on nodes without sharing them: nodes of welds and tied nodes, which lie on sheets, and cards that join nodes. Rules:
// docs/connections.md.
#pragma once

#include <compare>
#include <cstdint>
#include <vector>

#include "mesh/model/model.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::document {

/// A node that lies on a sheet without being a corner of it.
struct NodeOnSheet {
  NodeIndex node;
  ShellIndex shell;              ///< the nearest, when the deck was opened
  double reach = 0;              ///< farther than this from the sheet it doesn't lie on it
  bool tied = false;             ///< a node of another sheet that a contact ties: it doesn't follow
  ElementClass element_class{};  ///< not tied: the element it belongs to
  std::uint32_t of = 0;          ///< that element's index, or the number of the contact's card among the referrers
};

/// A card that joins nodes: a rigid body, a weld, a joint, an equation.
struct JoiningCard {
  std::uint32_t referrer = 0;
  NodeSet nodes;
};

struct JoinedNode {
  NodeIndex node;
  std::uint32_t card = 0;  ///< index into Dependents::joining_cards
  auto operator<=>(const JoinedNode&) const = default;
};

/// Found once, when a deck is opened; by index, so it holds for all generations.
struct Dependents {
  std::vector<NodeOnSheet> on_sheets;             ///< ascending by node
  std::vector<std::uint32_t> on_sheets_by_shell;  ///< indices into on_sheets, ascending by shell
  std::vector<JoiningCard> joining_cards;
  std::vector<JoinedNode> joined_nodes;  ///< ascending
};

}  // namespace prismesh::mesh::document

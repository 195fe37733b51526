// What depends on nodes without sharing them: nodes of welds and tied nodes, which lie on sheets, and cards that join nodes. Rules:
// docs/connections.md.
#pragma once

#include <compare>
#include <cstdint>
#include <vector>

#include "mesh/connections/node_on_sheet.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::document {

using connections::NodeOnSheet;

/// A card that joins nodes: a rigid body, a weld, a joint, an equation.
struct JoiningCard {
  std::uint32_t referrer = 0;
  NodeSet nodes;
  bool joins_sheets = false;  ///< a spot weld, a rivet, or a rigid body of few nodes
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

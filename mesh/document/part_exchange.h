// Decides what becomes of a part's nodes and shells, and of those of the mesh that takes their place: which keep their entries in the
// model, which come and go, and what the new ones come from. Private to mesh/document.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "mesh/document/document.h"
#include "mesh/document/edit.h"
#include "mesh/model/topology_change.h"

namespace prismesh::mesh::document {

/// A node of the part that something else uses or names, and that no new node takes the place of.
struct LostNode {
  NodeIndex node;
  std::string user;         ///< "part:4", "beam:9", "*SET_NODE_LIST 5"
  bool by_element = false;  ///< the user is a part or an element
  double nearest = 0;       ///< distance of the nearest new node
  bool stays = false;       ///< in the deck, without the part
};

/// A new node on an edge that the part shared with another one, between that one's nodes.
struct NodeBetween {
  std::size_t node = 0;  ///< of the mesh
  std::array<NodeIndex, 2> ends;
  PartIndex part;
};

struct PartExchange {
  // by the mesh's nodes and shells
  std::vector<NodeIndex> node;            ///< the part's node whose place it takes; invalid: a new one
  std::vector<NodeOrigin> origin;         ///< of new ones: nodes of the part
  std::vector<ShellIndex> shell;          ///< likewise
  std::vector<ShellIndex> parent;         ///< of new ones
  std::vector<std::uint8_t> keeps_place;  ///< a node stays where it is: another part or element has it, or it is held

  ShellSet old_shells;  ///< all of the part
  ShellSet removed_shells;
  NodeSet removed_nodes;
  std::vector<LostNode> lost;
  std::vector<NodeBetween> between;
  ShellSet lost_segments;              ///< old shells that cards name as segments, and that no new shell comes from
  std::size_t joined_by_elements = 0;  ///< nodes of other parts and elements that the new mesh has
  std::size_t joined_by_cards = 0;     ///< other nodes that cards name, likewise
  std::vector<std::string> notes;
};

/// `mesh` is sound: each of its shells has nodes of it. `part` has shells. Costs the part, the mesh and the cards that name the part's
/// nodes and shells.
PartExchange plan_exchange(const Document& document, PartIndex part, const VariantMesh& mesh, double tolerance);

/// Three quarters of the mean side of the mesh's shells: no point of a square is farther from its corners than 0.71 sides.
double default_tolerance(const VariantMesh& mesh);

}  // namespace prismesh::mesh::document

// Nodes that lie on sheets, and the elements at nodes that this is found from.
#pragma once

#include <compare>
#include <cstdint>

#include "mesh/model/model.h"

namespace prismesh::mesh::connections {

/// An element other than a shell at a node. It moves with the node.
struct ElementUse {
  NodeIndex node;
  ElementClass element_class = ElementClass::other;
  std::uint32_t element = 0;  ///< index in Model::elements[element_class]
  auto operator<=>(const ElementUse&) const = default;
};

/// A node that lies on a sheet without being a corner of it.
struct NodeOnSheet {
  NodeIndex node;
  ShellIndex shell;              ///< the nearest, when the deck was opened
  double reach = 0;              ///< farther than this from the sheet it doesn't lie on it
  bool tied = false;             ///< a node of another sheet that a contact ties: it doesn't follow
  ElementClass element_class{};  ///< not tied: the element it belongs to
  std::uint32_t of = 0;          ///< that element's index, or the number of the contact's card among the referrers
};

}  // namespace prismesh::mesh::connections

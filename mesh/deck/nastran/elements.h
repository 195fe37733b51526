// The entries that make elements, and the fields of their property and nodes.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "mesh/deck/data/deck.h"
#include "mesh/deck/nastran/card.h"

namespace prismesh::mesh::deck::nastran {

/// How an element's nodes are found among its fields.
enum class NodeFields : std::uint8_t {
  shell,          ///< corners, then mid-side nodes
  in_a_row,       ///< from `first` on, `corners` of which must be there
  with_freedoms,  ///< node, freedom, node, freedom; a blank freedom: the node is a scalar point; a blank node: the ground
  scalar_points,  ///< no nodes
  pairs,          ///< two elements of two nodes each on a card: PLOTEL
  rbe1,
  rbe2,
  rbe3,
  rspline,
  rsscon,
  weld,        ///< CWELD
  fastener,    ///< CFAST
  none_shown,  ///< counted only: aerodynamic panels and the like
};

struct ElementForm {
  std::string_view name;
  ElementClass element_class = ElementClass::other;
  NodeFields fields = NodeFields::in_a_row;
  std::int8_t property = 1;  ///< data field; -1: it has none
  std::uint8_t first = 2;    ///< data field of the first node
  std::uint8_t nodes = 0;    ///< at most
  std::uint8_t corners = 0;  ///< that must be there
};

/// nullptr: it is no element, or none that is read.
const ElementForm* element_form(std::string_view name);
/// An element of the 1970s that newer solvers don't read either.
bool is_old_element(std::string_view name);
/// An element that is kept but not read.
bool is_unread_element(std::string_view name);

/// The data fields of a shell card besides its nodes; 0: it has no such field.
struct ShellFields {
  std::uint8_t corners = 4;
  std::uint8_t midside = 0;    ///< how many follow the corners
  std::uint8_t angle = 0;      ///< THETA or MCID
  std::uint8_t offset = 0;     ///< ZOFFS
  std::uint8_t relative = 0;   ///< TFLAG: 1 if the thicknesses are shares of the property's
  std::uint8_t thickness = 0;  ///< of the first corner; the others follow
};
ShellFields shell_fields(std::string_view name);

/// Reads an element's nodes by id, in the order of its card, without blanks and scalar points. False: a node that it must have is missing.
bool read_nodes(const Card& card, const ElementForm& form, std::vector<std::int64_t>& nodes);

}  // namespace prismesh::mesh::deck::nastran

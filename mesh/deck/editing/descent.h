// From what in the deck's text an added node or a changed shell comes.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/deck/data/deck.h"
#include "mesh/deck/writing/card_writer.h"
#include "mesh/model/topology_change.h"

namespace prismesh::mesh::deck {

/// The deck's nodes from which a node comes, through however many generations, ascending; of a deck's node itself.
std::vector<NodeIndex> deck_ancestors(const Model& model, NodeIndex node);

/// The node of the deck behind whose card a new node's card goes: the last of those it comes from whose file may be written to (see
/// CardRun); invalid if there is none.
NodeIndex home_of(const Model& model, NodeIndex added);
/// The same for a node that isn't there yet.
NodeIndex home_of(const Model& model, const NodeOrigin& origin);

/// A shell that is there as its card has to show it, after the example of the card of its deck_ancestor: ids as in the model, corners'
/// shares and the turn. Where a corner comes from elsewhere (a node of a neighbour, after a collapse), its share is that of the nearest
/// place on the ancestor.
ShellCard shell_card(const Model& original, const Model& model, ShellIndex shell);

}  // namespace prismesh::mesh::deck

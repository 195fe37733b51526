// Finds the nodes and shells of the deck that added and reshaped ones come from.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/deck/data/deck.h"
#include "mesh/deck/writing/card_writer.h"
#include "mesh/model/topology_change.h"

namespace prismesh::mesh::deck {

/// The deck's nodes that a node comes from, through any number of generations, ascending. For a node of the deck: itself.
std::vector<NodeIndex> deck_ancestors(const Model& model, NodeIndex node);

/// The node of the deck whose card is the example for an added node's card, which goes behind it: the last of those it comes from that has
/// a card of its own in a file that may be changed. Invalid: there is none.
NodeIndex example_node(const Model& model, NodeIndex added);
/// The same for a node that will be added.
NodeIndex example_node(const Model& model, const NodeOrigin& origin);

/// What a shell's card must say, with its deck_ancestor's card as the example: ids as in the model, the shares of the ancestor's corners at
/// each corner, and the turn of the first edge. A corner that doesn't come from the ancestor's corners (a node of a neighbour, after a
/// collapse) gets the shares at the nearest place on the ancestor. Precondition: the shell isn't removed.
ShellCard shell_card(const Model& original, const Model& model, ShellIndex shell);

}  // namespace prismesh::mesh::deck

// Selection as sets and as marks, and what part states do to nodes. Private to mesh/document.
#pragma once

#include "mesh/document/document.h"

namespace prismesh::mesh::document {

/// What is selected, as sets.
struct Picked {
  NodeSet nodes;
  ShellSet shells;  ///< empty when nodes were selected
  select::Kind kind = select::Kind::node;
};

Picked picked(const Generation& generation);
/// Selected shells. Costs the chunks that hold one, and a pointer comparison a chunk.
ShellSet selected_shells(const Generation& generation);

/// Makes `after` the selection of `next`, whose marks still are those of `before`: only what differs is written.
void put_selection(Generation& next, const Picked& before, const Picked& after);

/// A node by id, or the nearest to coordinates. Errors: no such node.
Result<NodeIndex> find_place(const Model& model, const Place& place);

/// The nodes that `where` names on this generation. Errors: those of the expression, no such node, nothing there.
Result<NodeSet> nodes_at(const Generation& generation, const Where& where);

/// An entry for each part, 1 where it is hidden; empty if none is.
std::vector<std::uint8_t> hidden_parts(const Generation& generation);

/// A region of what is in sight: shells, or the nodes of a loop of free edges. Errors: no such node, no shell in sight there, no free edge.
Result<Picked> region_at(const Generation& generation, const SelectRegion& recipe);
/// The nodes in an outline that belong to parts in sight; if asked, those that no shell hides. Errors: a view without depth.
Result<NodeSet> nodes_in_outline(const Generation& generation, const SelectLasso& recipe);

/// The parts' states as they bear on nodes: sets kLocked and kHidden in `marks`, leaving the other bits. Costs the model.
void mark_parts(const Model& model, const std::vector<PartState>& states, ChunkedArray<std::uint8_t>& marks);

}  // namespace prismesh::mesh::document

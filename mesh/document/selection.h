// The selection of a generation, as sets and as marks.
#pragma once

#include "mesh/document/generation.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::document {

struct Selection {
  NodeSet nodes;
  ShellSet shells;  ///< empty when nodes were selected
  select::EntityKind kind = select::EntityKind::node;
};

Selection selection_of(const Generation& generation);
NodeSet selected_nodes(const Generation& generation);
/// Costs the chunks that hold a selected shell, and a pointer comparison a chunk.
ShellSet selected_shells(const Generation& generation);

/// Makes `after` the selection of `next`, whose marks are still those of `before`. Writes only the differences.
void put_selection(Generation& next, const Selection& before, const Selection& after);

}  // namespace prismesh::mesh::document

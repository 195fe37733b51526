// Finds the nodes and shells that an edit names. Private to mesh/document.
#pragma once

#include "base/error.h"
#include "mesh/document/edit.h"
#include "mesh/document/generation.h"
#include "mesh/document/referenced_node.h"
#include "mesh/document/selection.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::document {

/// The nodes that `target` names on this generation. Errors: those of the expression, no such node, nothing there.
Result<NodeSet> nodes_at(const Generation& generation, const TargetNodes& target);

/// A region of visible parts: shells, or the nodes of a loop of free edges. Errors: no such node, no visible shell there, no free edge.
Result<Selection> region_at(const Generation& generation, const SelectRegion& recipe);
/// The nodes in an outline that belong to visible parts; with `visible`, those that no shell hides. Errors: a view without depth.
Result<NodeSet> nodes_in_outline(const Generation& generation, const SelectLasso& recipe);

}  // namespace prismesh::mesh::document

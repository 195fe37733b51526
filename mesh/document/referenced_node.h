// Finds the node that an edit names. Private to mesh/document.
#pragma once

#include "base/error.h"
#include "mesh/document/edit.h"
#include "mesh/model/model.h"

namespace prismesh::mesh::document {

/// A node by id, or the nearest to coordinates. Errors: no such node.
Result<NodeIndex> find_referenced_node(const Model& model, const NodeReference& reference);

}  // namespace prismesh::mesh::document

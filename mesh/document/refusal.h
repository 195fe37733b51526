// Nodes that must stay where they are, and the words for it. Private to mesh/document.
#pragma once

#include "mesh/document/document.h"

namespace prismesh::mesh::document {

/// An error if one of `nodes` belongs to a locked part or its coordinates can't be written: names the first, why, and how many.
/// `document` (may be null) adds the file, the line and the parameter's name.
Result<void> refuse_held(const Generation& generation, const NodeSet& nodes, const Document* document);

}  // namespace prismesh::mesh::document

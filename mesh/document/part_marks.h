// Derives the marks of nodes from the states of parts. Private to mesh/document.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/document/generation.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::document {

/// An entry for each part, 1 where it is hidden; empty if none is.
std::vector<std::uint8_t> hidden_parts(const Generation& generation);

/// Sets kLocked and kHidden in `marks` from the parts' states and keeps the other bits. Costs the model.
void mark_parts(const Model& model, const std::vector<PartState>& states, ChunkedArray<std::uint8_t>& marks);
/// The same at a few nodes of a generation.
void mark_parts_at(const NodeSet& nodes, Generation& next);

}  // namespace prismesh::mesh::document

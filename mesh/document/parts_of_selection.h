// The parts that edits of parts act on. Private to mesh/document.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/document/document.h"

namespace prismesh::mesh::document {

using PartFlags = std::vector<std::uint8_t>;  ///< by PartIndex: 1 if the edit names the part

/// The parts of the selection: of the selected shells; for nodes, of the shells with all nodes selected, or, if there are none, of all
/// shells that touch it; and of other elements at nodes that no shell uses.
PartFlags parts_of_selection(const Document& document);

}  // namespace prismesh::mesh::document

// Finds the lines to draw for elements that aren't shells: beams and discrete elements, and the edges of the outer faces of solids and
// thick shells.
#pragma once

#include "mesh/model/model.h"

namespace prismesh::mesh {

struct ElementLines {
  ChunkedArray<NodeIndex> nodes;  ///< pairs
  ChunkedArray<PartIndex> parts;  ///< of each pair; invalid where the card names none
};

/// For solids: the edges of faces that belong to one element only, each edge once. Costs the model.
ElementLines element_lines(const Model& model);

}  // namespace prismesh::mesh

// What is drawn of elements that aren't shells: beams and discrete elements as lines, solids and thick shells by the
// outline of their outer faces.
#pragma once

#include "mesh/model/model.h"

namespace prismesh::ipc {

struct Outlines {
  mesh::ChunkedArray<mesh::NodeIndex> nodes;  ///< pairs
  mesh::ChunkedArray<mesh::PartIndex> parts;  ///< of each pair; invalid where the card names none
};

/// Of solids: the edges of faces that belong to one element only, each edge once for all. Costs the model once.
Outlines outlines(const mesh::Model& model);

}  // namespace prismesh::ipc

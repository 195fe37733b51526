// What an expression selects: entities of one kind.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/model/model.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::select {

enum class Kind : std::uint8_t { node, element, part };

/// What an expression names. Bare numbers are ids of the kind in hand; `node:`, `shell:`, `part:` and the other element
/// classes change it for one item.
struct Chosen {
  NodeSet nodes;                 ///< kind node: the nodes; element: the nodes of `shells`; part: of all the parts' elements
  ShellSet shells;               ///< kind element: the shells; part: the shells of `parts`; else empty
  std::vector<PartIndex> parts;  ///< kind part: the parts, ascending, also those without shells; else empty
  bool of_surfaces = false;      ///< every item names shells, parts, sets of those or files
};

}  // namespace prismesh::mesh::select

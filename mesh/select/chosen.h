// The result of an expression: entities of one kind.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/model/model.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::select {

/// What an expression selects.
enum class EntityKind : std::uint8_t { node, element, part };

/// The entities that an expression names. Numbers without a class are ids of the wanted kind; `node:`, `shell:`, `part:` and the other
/// element classes before a number say otherwise for one item.
struct Chosen {
  NodeSet nodes;                 ///< kind node: the nodes; element: the nodes of `shells`; part: the nodes of all elements of the parts
  ShellSet shells;               ///< kind element: the shells; part: the shells of `parts`; else empty
  std::vector<PartIndex> parts;  ///< kind part: the parts, ascending, also those without shells; else empty
  bool of_surfaces = false;      ///< every item names shells, parts, sets of those or files
};

}  // namespace prismesh::mesh::select

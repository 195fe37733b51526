// Abaqus's element types (*ELEMENT, TYPE=...), and those of CalculiX that differ.
// Source: Abaqus Analysis User's Guide, "Elements"; CalculiX CrunchiX user's manual, "Element types".
#pragma once

#include <cstdint>
#include <string_view>

#include "mesh/deck/data/deck.h"
#include "mesh/model/model.h"

namespace prismesh::mesh::deck::abaqus {

struct ElementType {
  ElementClass element_class = ElementClass::other;
  std::uint8_t nodes = 0;        ///< on a card; 0: any number
  std::uint8_t corners = 0;      ///< of a shell: 3 or 4; as many mid-side nodes follow, if there are more nodes
  bool is_shell_section = true;  ///< false for what is no shell to the solver: membranes, surfaces, rigid facets
  bool operator==(const ElementType&) const = default;

  bool has_midside() const { return corners > 0 && nodes > corners; }
};

/// `type` in capitals. An unknown type is of class other, with any number of nodes.
ElementType element_type(std::string_view type);

void count(const ElementType& type, ElementCounts& counts, std::size_t cards);

}  // namespace prismesh::mesh::deck::abaqus

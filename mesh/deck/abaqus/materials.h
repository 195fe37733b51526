// Reads sections and materials: thickness, density and stiffness of parts.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "mesh/deck/abaqus/outline.h"

namespace prismesh::mesh::deck::abaqus {

struct Section {
  std::uint32_t scope = 0;
  std::string elset;  ///< as written
  Part part;          ///< with thickness and material, without id and name
};

/// All sections, in their order; with *MASS, *SPRING and others that name an element set.
std::vector<Section> sections(const DeckOutline& outline);

}  // namespace prismesh::mesh::deck::abaqus

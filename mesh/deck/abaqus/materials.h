// Sections and materials: what a part's thickness, density and stiffness are.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "mesh/deck/abaqus/walk.h"

namespace prismesh::mesh::deck::abaqus {

struct Section {
  std::uint32_t scope = 0;
  std::string elset;  ///< as written
  Part part;          ///< with thickness and material, without id and name
};

/// All sections, in their order. *MASS, *SPRING and the like that name an element set are such too.
std::vector<Section> sections(const Walk& walk);

}  // namespace prismesh::mesh::deck::abaqus

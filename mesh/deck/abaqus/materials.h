// Reads sections and materials: thickness, density and stiffness of parts.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "mesh/deck/abaqus/outline.h"
#include "mesh/model/contact_cards.h"

namespace prismesh::mesh::deck::abaqus {

struct Section {
  std::uint32_t scope = 0;
  std::string elset;  ///< as written
  Part part;          ///< with thickness and material, without id and name
  double offset = 0;  ///< of the middle surface from the nodes along the normal, as a share of the thickness
};

/// All sections, in their order; with *MASS, *SPRING and others that name an element set.
std::vector<Section> sections(const DeckOutline& outline);

/// The offsets of all sections; contact surfaces of all shells follow them. Source: Abaqus Analysis User's Guide, "Shell section behavior,
/// Reference surface offsets", "Contact pairs in Abaqus/Explicit, Shell thickness and offset".
ContactCards section_offsets(const DeckOutline& outline);

}  // namespace prismesh::mesh::deck::abaqus
